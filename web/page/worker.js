// The worker: all that takes time. It reads pictures, places their dots and writes files, and listens between the
// steps, so that what is no longer wanted stops.
"use strict";

// Pictures with more pixels are made smaller: their dots could not be told from those of the smaller one.
const MOST_PIXELS = 4e6;

const READ = "PNG, JPEG, Radiance HDR, PFM, and what this browser shows. The program reads more.";

const MODES = { fixed: 0, relaxed: 1, refined: 2 };

let source = null; // what was opened: bytes or pixels, with a name
let photograph = null; // the engine's picture of it, in `tones`
let tones = "";
let camera = null;
let wanted = 0; // the number of the drawing that is wanted; others are dropped
let stopping = false; // whether that one is to end as it is
let loaded = null; // the promise of an engine
const drawn = new Map(); // what was drawn last, by mode

// A turn of the event loop: messages that have come are heard.
const turns = [];
const turning = new MessageChannel();
turning.port1.onmessage = () => turns.shift()();
function turn() {
  return new Promise((resolve) => {
    turns.push(resolve);
    turning.port2.postMessage(null);
  });
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

function engineTones({ linear, invert, gain }) {
  return new wasm_bindgen.Tones(linear, invert, gain);
}

// Pixels of a picture that the engine cannot read but the browser can.
async function browserPixels(bytes) {
  const bitmap = await createImageBitmap(new Blob([bytes]));
  const shrink = Math.min(1, Math.sqrt(MOST_PIXELS / (bitmap.width * bitmap.height)));
  const width = Math.max(1, Math.floor(bitmap.width * shrink));
  const height = Math.max(1, Math.floor(bitmap.height * shrink));
  const context = new OffscreenCanvas(width, height).getContext("2d");
  context.imageSmoothingQuality = "high";
  context.drawImage(bitmap, 0, 0, width, height);
  const whole = [bitmap.width, bitmap.height];
  bitmap.close();
  return { rgba: context.getImageData(0, 0, width, height).data, width, height, whole };
}

async function read(source, settings) {
  const found = engineTones(settings);
  try {
    if (!source.pixels) {
      try {
        return wasm_bindgen.Photograph.read(source.bytes, source.name, found, MOST_PIXELS);
      } catch (error) {
        if (error.name !== "UnknownFormat") throw error;
        source.pixels = await browserPixels(source.bytes).catch(() => {
          throw new Error(`is not a picture that can be read here: ${READ}`);
        });
      }
    }
    const { rgba, width, height } = source.pixels;
    return wasm_bindgen.Photograph.of_rgba(rgba, width, height, found, MOST_PIXELS);
  } finally {
    found.free();
  }
}

function about(picture, whole) {
  const { width, height, dots, warnings } = picture;
  return { width, height, dots, warnings, whole: whole ?? Array.from(picture.whole) };
}

const tasks = {
  load({ engine }) {
    loaded = inflate(engine).then((bytes) => wasm_bindgen({ module_or_path: bytes }));
    return loaded.then(() => null);
  },

  // A file's bytes or a canvas's pixels become the picture that is drawn.
  async open({ bytes, pixels, name, settings }) {
    wanted += 1;
    const opened = { bytes: bytes && new Uint8Array(bytes), pixels, name };
    const picture = await read(opened, settings);
    photograph?.free();
    [source, photograph, tones] = [opened, picture, JSON.stringify(settings)];
    return about(photograph, source.pixels?.whole);
  },

  // The dots of the picture in each of some modes, shown as they move.
  async draw({ settings, modes, dots, seed, refine, watched }, say) {
    const mine = (wanted += 1);
    stopping = false;
    const asked = JSON.stringify(settings);
    if (asked !== tones) {
      const picture = await read(source, settings);
      if (mine !== wanted) {
        picture.free();
        return null;
      }
      photograph.free();
      [photograph, tones] = [picture, asked];
    }
    const picture = photograph;
    const usual = picture.dots;
    const count = dots ?? usual;
    const about = { dots: count, usual, size: [picture.width, picture.height], dotSize: picture.dot_size(count) };
    for (const mode of modes) {
      const began = performance.now();
      let cut = null; // after how many steps it was stopped
      const pause = async (step, places) => {
        say({ mode, step, of: refine, about, places: watched ? places : null });
        await turn();
        if (stopping) cut = step;
        return mine === wanted && !stopping;
      };
      const stippled = await picture.stipple(MODES[mode], count, seed, refine, watched, pause);
      if (mine !== wanted) {
        stippled.free();
        return null;
      }
      drawn.get(mode)?.free();
      drawn.set(mode, stippled);
      say({ mode, about, places: stippled.places(), milliseconds: performance.now() - began });
      await turn();
      if (mine !== wanted) return null;
      if (stopping) return { cut };
    }
    return {};
  },

  stop() {
    stopping = true;
  },

  // What was drawn last, as a file.
  file({ mode, kind, title, dotSize, scale }) {
    if (!drawn.has(mode)) throw new Error("cannot be written: nothing is drawn to the end");
    return drawn.get(mode).file(kind, title, dotSize, scale).buffer;
  },

  // A frame of a camera: its dots, at once.
  async frame({ pixels, settings, mode, dots, seed, refine }, say) {
    const mine = (wanted += 1);
    camera ??= new wasm_bindgen.Camera();
    const found = engineTones(settings);
    let picture;
    try {
      picture = camera.frame(pixels.rgba, pixels.width, pixels.height, found);
    } finally {
      found.free();
    }
    const pause = async () => mine === wanted;
    const stippled = await picture.stipple(MODES[mode], dots, seed, refine, false, pause);
    const about = { dots, size: [pixels.width, pixels.height], dotSize: picture.dot_size(dots) };
    picture.free();
    say({ mode, about, places: stippled.places() });
    drawn.get(mode)?.free();
    drawn.set(mode, stippled);
    return about;
  },

  // Forgets what the camera saw.
  unplug() {
    camera?.free();
    camera = null;
  },

  // The tiles that a walk opens under a painted importance.
  descent({ importance, side, density, seed }) {
    const descent = new wasm_bindgen.Descent(importance, side, density, seed);
    const found = { tiles: descent.tiles, points: descent.points };
    descent.free();
    return found;
  },

  stars() {
    return [0, 1, 2, 3].map((kind) => Array.from(wasm_bindgen.Descent.star(kind)));
  },
};

self.onmessage = async ({ data: { id, task, data } }) => {
  try {
    if (task !== "load") await loaded;
    const say = (said) => self.postMessage({ id, said });
    self.postMessage({ id, result: await tasks[task](data ?? {}, say) });
  } catch (error) {
    // A trap leaves the engine in pieces.
    const fatal = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
    self.postMessage({ id, error: fatal ? "" : String(error?.message ?? error), fatal });
  }
};
