// The drawing view, as people use it; its files beside the program's.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { deflateSync } from "node:zlib";
import {
  PHOTOGRAPH, FOLDER_ADDRESS, ROOT, browser, dotsIn, download, drawn, drop, dropBytes, folder, opened, program, redrawn, serve,
} from "./common.mjs";

let server, chromium, context;

before(async () => {
  server = await serve();
  chromium = await browser();
  context = await chromium.newContext();
});

after(async () => {
  await chromium?.close();
  server?.close();
});

async function fresh() {
  const page = await opened(context, server.address);
  return page;
}

// Sets a number or a slider as a person would: with the keyboard.
async function set(page, id, value) {
  await redrawn(page, () => page.fill(`#${id}`, String(value)));
}

const choose = (page, mode) => redrawn(page, () => page.check(`[name=show][value=${mode}]`, { force: true }));

test("it draws a sample at once, and asks nobody for anything", async () => {
  const page = await fresh();
  assert.match(await page.textContent("#status"), /^[\d,]+ dots, in [\d.]+ m?s\./);
  const shades = await page.evaluate(() => {
    const canvas = document.querySelector("#panes canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return new Set(data).size;
  });
  assert.ok(shades > 50, `${shades} shades`);
  assert.ok(page.asked.every((address) => address.startsWith(server.address) || /^(blob|data):/.test(address)));
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("a dropped file becomes the program's drawing, byte for byte, whatever the settings", async () => {
  const page = await fresh();
  await redrawn(page, () => drop(page, PHOTOGRAPH));
  const same = async (options) => {
    const svg = await download(page, "svg");
    assert.equal(svg.name, "camera.svg");
    const expected = program(PHOTOGRAPH, "svg", options);
    assert.equal(dotsIn(svg.bytes), dotsIn(expected));
    assert.ok(svg.bytes.equals(expected), `SVG with ${options.join(" ")}`);
    return dotsIn(svg.bytes);
  };
  const usual = await same([]);
  assert.ok(usual > 10000);
  await set(page, "dots-number", 3000);
  await same(["--points", 3000]);
  await set(page, "seed", 5);
  await same(["--points", 3000, "--seed", 5]);
  await set(page, "refine", 3);
  await same(["--points", 3000, "--seed", 5, "--refine", 3]);
  await redrawn(page, () => page.check("#invert"));
  await same(["--points", 3000, "--seed", 5, "--refine", 3, "--invert"]);
  await redrawn(page, () => page.check("#linear"));
  await same(["--points", 3000, "--seed", 5, "--refine", 3, "--invert", "--linear"]);
  await redrawn(page, () => page.uncheck("#gain"));
  await same(["--points", 3000, "--seed", 5, "--refine", 3, "--invert", "--linear", "--dot-gain", "ignore"]);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("fixed, relaxed and refined dots are the program's to the bit, and so is the picture of them", async () => {
  const page = await fresh();
  await redrawn(page, () => drop(page, PHOTOGRAPH));
  await set(page, "dots-number", 5000);
  const gain = ["--points", 5000, "--dot-gain", "correct"];
  const modes = {
    fixed: ["--centers", "fixed", "--refine", 0],
    relaxed: ["--refine", 0],
    refined: [],
  };
  for (const [mode, options] of Object.entries(modes)) {
    // The chosen one is chosen already.
    if (mode !== "refined" || !(await page.isChecked("[value=refined]"))) await choose(page, mode);
    const csv = await download(page, "csv");
    // The shortest decimals that give a 32-bit number back: equal texts are equal bits.
    assert.ok(csv.bytes.equals(program(PHOTOGRAPH, "csv", [...gain, ...options])), mode);
    assert.ok(csv.bytes.toString().trim().split("\n").length > 4900);
  }
  const png = await download(page, "png");
  assert.ok(png.bytes.equals(program(PHOTOGRAPH, "png", ["--points", 5000, "--scale", 3])), "PNG");
  await choose(page, "all");
  assert.match(await page.textContent("#status"), /fixed, .*relaxed, .*refined, in/);
  assert.equal(await page.locator("#panes canvas").count(), 3);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("a slider moves the number of dots, and their size only how they look", async () => {
  const page = await fresh();
  const count = (status) => Number(status.split(" ")[0].replaceAll(",", ""));
  const before = count(await page.textContent("#status"));
  await page.focus("#dots");
  const after = count(await redrawn(page, async () => {
    for (let i = 0; i < 50; i++) await page.keyboard.press("ArrowRight");
  }));
  assert.ok(after > before * 1.2, `${before} to ${after}`);
  const ink = () => page.evaluate(() => {
    const canvas = document.querySelector("#panes canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.reduce((sum, value, i) => sum + (i % 4 === 0 ? 255 - value : 0), 0);
  });
  const thin = await ink();
  await page.fill("#size", "200");
  await page.waitForTimeout(300);
  assert.ok((await ink()) > 1.3 * thin);
  const svg = (await download(page, "svg")).bytes.toString();
  assert.equal(dotsIn(svg), after);
  await page.close();
});

test("what cannot be read is said, and what was there stays", async () => {
  const page = await fresh();
  const status = () => page.textContent("#status");
  const refused = async (base64, name, reason) => {
    await dropBytes(page, base64, name);
    await page.waitForSelector("#trouble:not([hidden])");
    await page.waitForFunction(() => !document.body.hasAttribute("aria-busy"));
    const said = await page.textContent("#trouble");
    assert.ok(said.startsWith(`${name} `) && reason.test(said), said);
    assert.match(await status(), /Still showing photographer\.jpg/);
  };
  await refused(Buffer.from("dear diary").toString("base64"), "diary.txt", /is not a picture that can be read here: PNG, JPEG/);
  await refused("", "nothing.jpg", /is not a picture/);
  await refused(program(PHOTOGRAPH, "png").subarray(0, 20000).toString("base64"), "half.png", /ends early/);
  await refused(png(8, 8, () => 255).toString("base64"), "white.png", /is all white.*White on black/);
  await redrawn(page, () => drop(page, PHOTOGRAPH));
  assert.ok(await page.isHidden("#trouble"));
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("what only the browser can read is read by the browser", async () => {
  const page = await fresh();
  const inner = png(64, 64, (x) => 4 * x);
  const head = Buffer.from([0, 0, 1, 0, 1, 0, 64, 64, 0, 0, 1, 0, 8, 0, 0, 0, 0, 0, 22, 0, 0, 0]);
  head.writeUInt32LE(inner.length, 14);
  await redrawn(page, () => dropBytes(page, Buffer.concat([head, inner]).toString("base64"), "icon.ico"));
  assert.ok(await page.isHidden("#trouble"));
  const svg = (await download(page, "svg")).bytes;
  assert.match(svg.toString(), /viewBox="0 0 64 64"/);
  await page.close();
});

test("a big picture is made smaller, with a word", async () => {
  const page = await fresh();
  const path = join(folder, "big.png");
  writeFileSync(path, png(3000, 2000, (x, y) => ((x >> 3) ^ (y >> 3)) & 255));
  const status = await redrawn(page, () => drop(page, path));
  assert.match(status, /The picture of 3000 × 2000 pixels was made smaller, 1500 × 1000/);
  await page.close();
});

test("a long drawing leaves the page at hand, and can be stopped", async () => {
  const page = await fresh();
  await page.evaluate(() => {
    window.longest = 0;
    let last = performance.now();
    const tick = (now) => {
      window.longest = Math.max(window.longest, now - last);
      last = now;
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  });
  await page.fill("#refine", "50");
  await page.fill("#dots-number", "150000");
  await page.waitForFunction(() => document.getElementById("progress").value > 0.1, null, { timeout: 60000 });
  const began = Date.now();
  await page.click("#stop");
  await page.waitForFunction(() => !document.body.hasAttribute("aria-busy"));
  assert.ok(Date.now() - began < 5000);
  assert.match(await page.textContent("#status"), /^15\d,\d{3} dots, .* Stopped after \d+ of 50\.$|^Stopped\.$/);
  const longest = await page.evaluate(() => window.longest);
  // A frozen page would be the whole drawing, some ten seconds; machines that others use too skip frames.
  assert.ok(longest < 1000, `${longest} ms without a frame`);
  await set(page, "dots-number", 2000);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("a worker that does not hear a stop is replaced, and the new one knows the picture", async () => {
  const page = await fresh();
  await redrawn(page, () => drop(page, PHOTOGRAPH));
  await page.fill("#refine", "50");
  await page.fill("#dots-number", "50000");
  await page.waitForFunction(() => document.getElementById("progress").value > 0, null, { timeout: 60000 });
  const [deaf] = page.workers();
  const until = Date.now() + 60000;
  deaf.evaluate((until) => {
    while (Date.now() < until);
  }, until).catch(() => {});
  await page.waitForTimeout(100);
  await page.click("#stop");
  await page.waitForFunction(() => !document.body.hasAttribute("aria-busy"), null, { timeout: 10000 });
  await set(page, "dots-number", 2000);
  const svg = await download(page, "svg");
  assert.ok(svg.bytes.equals(program(PHOTOGRAPH, "svg", ["--points", 2000, "--refine", 50])));
  assert.ok(Date.now() < until, "it was drawn by the worker that hears nothing");
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("zoom: buttons, keys and the wheel; the whole picture again", async () => {
  const page = await fresh();
  const now = () => page.textContent("#zoom-now");
  await page.click("#zoom-in");
  assert.equal(await now(), "150 %");
  await page.focus("#panes canvas");
  await page.keyboard.press("+");
  assert.equal(await now(), "225 %");
  await page.keyboard.press("ArrowRight");
  await page.hover("#panes canvas");
  await page.mouse.wheel(0, -400);
  await page.waitForFunction(() => parseInt(document.getElementById("zoom-now").textContent) > 400);
  await page.keyboard.press("0");
  assert.equal(await now(), "100 %");
  await page.close();
});

test("opened from a folder, without a server", async () => {
  const page = await opened(context, FOLDER_ADDRESS);
  await redrawn(page, () => drop(page, PHOTOGRAPH));
  const svg = await download(page, "svg");
  assert.ok(svg.bytes.equals(program(PHOTOGRAPH, "svg")));
  await page.click("#tab-tiles");
  await page.waitForFunction(() => /points?:/.test(document.getElementById("tiles-status").textContent));
  assert.ok(page.asked.every((address) => /^(file|blob|data):/.test(address)));
  assert.deepEqual(page.complaints, []);
  await page.close();
});

// Of lengths that leave 2, 0 and 6 bytes over when they are cut into sevens.
test("samples are unpacked as they were packed", async () => {
  const page = await opened(context, FOLDER_ADDRESS);
  const unpacked = await page.evaluate(() =>
    Object.entries(PACKED.samples).map(([name, packed]) => [name, [...new Uint8Array(bytesOf(packed))]]),
  );
  assert.equal(unpacked.length, 3);
  for (const [name, bytes] of unpacked) {
    assert.ok(readFileSync(join(ROOT, "web/samples", name)).equals(Buffer.from(bytes)), name);
  }
  await page.close();
});

// A gray PNG file of these pixels.
function png(width, height, pixel) {
  const rows = Buffer.alloc((width + 1) * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) rows[y * (width + 1) + 1 + x] = pixel(x, y);
  }
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header[8] = 8;
  const chunk = (name, data) => {
    const body = Buffer.concat([Buffer.from(name), data]);
    const [length, check] = [Buffer.alloc(4), Buffer.alloc(4)];
    length.writeUInt32BE(data.length);
    check.writeUInt32BE(crc32(body));
    return Buffer.concat([length, body, check]);
  };
  const start = Buffer.from("\x89PNG\r\n\x1a\n", "latin1");
  return Buffer.concat([start, chunk("IHDR", header), chunk("IDAT", deflateSync(rows)), chunk("IEND", Buffer.alloc(0))]);
}

function crc32(bytes) {
  let crc = -1;
  for (const byte of bytes) {
    crc ^= byte;
    for (let k = 0; k < 8; k++) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ -1) >>> 0;
}
