// The view that teaches: importance painted by hand, the tiles that a walk opens under it, and the points it finds.
"use strict";

// Pixels across the painting.
const SIDE = 96;

// Points a pixel where ink is full, at the ends of the slider, by powers.
const [THIN, RICH] = [0.004, 2];

const KINDS = ["hexagon a", "pentagon b", "pentagon c", "pentagon d"];
const KIND_COLORS = ["#c8553d", "#2a7f9e", "#d9a441", "#5b8c5a"];

// From the first ranks to the last: dark blue, teal, green, yellow.
const RAMP = [[56, 34, 110], [45, 93, 140], [33, 145, 140], [94, 201, 98], [250, 220, 60]];

class Tiles {
  constructor(engine) {
    this.engine = engine;
    this.canvas = element("tiles");
    this.context = this.canvas.getContext("2d");
    this.ink = new Float32Array(SIDE * SIDE);
    this.paper = document.createElement("canvas");
    this.paper.width = this.paper.height = SIDE;
    this.cursor = null; // the brush of the keyboard, in pixels of the painting
    this.descent = null;
    this.asking = false;
    this.stale = false;
    this.paint("spot");
    this.listen();
    this.tell();
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  get density() {
    return THIN * (RICH / THIN) ** (element("richness").valueAsNumber / 100);
  }

  tell() {
    const say = (id, text) => {
      element(`${id}-now`).textContent = text;
      element(id).setAttribute("aria-valuetext", text);
    };
    const points = Math.round(this.density * SIDE * SIDE);
    say("richness", points.toLocaleString("en"));
    say("brush-size", `${element("brush-size").value} %`);
    const depth = element("depth");
    say("depth", depth.value === depth.max ? "all" : `the first ${plural(Number(depth.value) + 1, "", "").trim()}`);
  }

  // A painting to begin with.
  paint(what) {
    for (let y = 0; y < SIDE; y++) {
      for (let x = 0; x < SIDE; x++) {
        const [u, v] = [(x + 0.5) / SIDE, (y + 0.5) / SIDE];
        const away = Math.hypot(u - 0.62, v - 0.4);
        const radius = Math.hypot(u - 0.5, v - 0.5);
        const ring = Math.exp(-(((radius - 0.32) / 0.07) ** 2));
        const value = { spot: Math.exp(-((away / 0.17) ** 2)), ramp: u * u, ring, clear: 0 }[what];
        this.ink[y * SIDE + x] = value < 0.004 ? 0 : value;
      }
    }
    this.changed();
  }

  // A dab of the brush.
  dab(x, y, erase) {
    const radius = (element("brush-size").valueAsNumber / 200) * SIDE;
    const reach = Math.ceil(radius);
    for (let j = Math.max(0, Math.floor(y - reach)); j < Math.min(SIDE, y + reach); j++) {
      for (let i = Math.max(0, Math.floor(x - reach)); i < Math.min(SIDE, x + reach); i++) {
        const part = Math.hypot(i + 0.5 - x, j + 0.5 - y) / radius;
        if (part >= 1) continue;
        const strength = 0.22 * (1 - part * part);
        const at = j * SIDE + i;
        const value = erase ? this.ink[at] - 1.5 * strength : this.ink[at] + strength;
        this.ink[at] = value < 0.004 ? 0 : Math.min(1, value);
      }
    }
    this.changed();
  }

  // Asks for the tiles of what is painted now; once more if it changed meanwhile.
  async changed() {
    const pixels = new ImageData(SIDE, SIDE);
    for (let i = 0; i < this.ink.length; i++) pixels.data[4 * i + 3] = 150 * this.ink[i];
    this.paper.getContext("2d").putImageData(pixels, 0, 0);
    this.draw();
    this.stale = true;
    if (this.asking) return;
    this.asking = true;
    try {
      while (this.stale) {
        this.stale = false;
        const importance = this.ink.slice();
        const seed = element("tiles-seed").valueAsNumber;
        const found = await this.engine.ask("descent", { importance, side: SIDE, density: this.density, seed });
        if (found) this.found(found);
      }
    } catch (error) {
      element("tiles-status").textContent = `Too much ink for this page: ${error.message}.`;
    } finally {
      this.asking = false;
    }
  }

  found({ tiles, points }) {
    const opened = new Set();
    const all = new Map();
    for (let i = 0; i < tiles.length; i += 8) {
      const [level, rank, kind, opens, x, y, dx, dy] = tiles.subarray(i, i + 8);
      const key = `${level} ${rank}`;
      if (opens) opened.add(key);
      else all.set(key, { level, rank, kind, x, y, edge: [dx, dy], opened: false, point: false });
    }
    for (const key of opened) all.get(key).opened = true;
    const list = [...all.values()];
    const first = list.reduce((least, tile) => Math.min(least, tile.level), 99);
    const last = list.reduce((most, tile) => Math.max(most, tile.level), 0);
    // Half of the numbers are the points where they were found, half where they are moved to.
    const half = points.length / 2;
    const spots = new Map();
    for (let i = 0; i < half; i += 3) spots.set(points[i], { x: points[i + 1], y: points[i + 2] });
    for (let i = half; i < points.length; i += 3) {
      const spot = spots.get(points[i]);
      if (spot) spot.moved = [points[i + 1], points[i + 2]];
    }
    for (const tile of list) tile.point = !tile.opened && spots.has(tile.rank);
    const ranks = list.map((tile) => Math.log1p(tile.rank)).sort((a, b) => a - b);
    // Of ranks, whose numbers grow with each level, the logarithms; the few first ones share a color.
    const [low, high] = [ranks[Math.floor(ranks.length / 50)] ?? 0, ranks.at(-1) ?? 1];
    this.descent = { list, spots, first, last, low, high, opened: opened.size };
    const depth = element("depth");
    const whole = depth.value === depth.max;
    depth.max = Math.max(1, last - first);
    if (whole) depth.value = depth.max;
    this.tell();
    this.report();
    this.draw();
  }

  report() {
    const { list, spots, opened } = this.descent;
    const looked = list.length;
    element("tiles-status").textContent =
      `${plural(spots.size, "point", "points")}: ${plural(opened, "tile", "tiles")} opened, ${looked.toLocaleString("en")} looked at.`;
  }

  color(tile) {
    const { low, high, first, last } = this.descent;
    const hue = document.querySelector("[name=hue]:checked").value;
    if (hue === "kind") return KIND_COLORS[tile.kind];
    if (hue === "level") return ramp((tile.level - first) / Math.max(1, last - first));
    return ramp((Math.log1p(tile.rank) - low) / Math.max(1e-9, high - low));
  }

  draw() {
    const ratio = window.devicePixelRatio || 1;
    const side = Math.round(this.canvas.clientWidth * ratio);
    if (!side) return;
    if (this.canvas.width !== side) this.canvas.width = this.canvas.height = side;
    const { context } = this;
    const style = getComputedStyle(this.canvas);
    const [ground, lines] = [style.getPropertyValue("--ground"), style.getPropertyValue("--lines")];
    const scale = side / SIDE;
    context.fillStyle = ground;
    context.fillRect(0, 0, side, side);
    if (this.descent && element("show-tiles").checked) {
      // Children do not fill their parents to the edge.
      context.fillStyle = style.getPropertyValue("--gaps");
      for (const tile of this.descent.list) {
        if (!tile.opened) continue;
        this.outline(tile, scale);
        context.fill();
      }
    }
    context.imageSmoothingEnabled = true;
    context.drawImage(this.paper, 0, 0, side, side);
    if (this.descent) {
      const { list, first } = this.descent;
      const deepest = first + element("depth").valueAsNumber;
      const shown = list.filter((tile) => tile.level <= deepest && (!tile.opened || tile.level === deepest));
      if (element("show-tiles").checked) {
        for (const tile of shown) {
          this.outline(tile, scale);
          context.fillStyle = this.color(tile);
          context.globalAlpha = tile.opened || tile.point ? 0.9 : 0.34;
          context.fill();
          context.globalAlpha = 1;
          context.strokeStyle = lines;
          context.lineWidth = Math.max(0.5, 0.6 * ratio);
          context.stroke();
        }
      }
      if (element("show-points").checked) this.points(shown, scale, ratio, style);
    }
    this.mark(scale, ratio, style);
    this.legend();
  }

  outline(tile, scale) {
    const { context } = this;
    const [dx, dy] = tile.edge;
    const star = this.stars?.[tile.kind] ?? [0, 2, 4, 6, 8, 10];
    context.beginPath();
    star.forEach((direction, i) => {
      const gap = (star[(i + 1) % star.length] - direction + 12) % 12;
      // The center of a triangle, or of a square, of the tiling at whose vertex the tile is.
      const distance = gap < 2.5 ? Math.sqrt(1 / 3) : Math.sqrt(1 / 2);
      const angle = ((direction + gap / 2) * Math.PI) / 6;
      const [c, s] = [distance * Math.cos(angle), distance * Math.sin(angle)];
      const x = (tile.x + c * dx - s * dy) * scale;
      const y = (tile.y + c * dy + s * dx) * scale;
      if (i) context.lineTo(x, y);
      else context.moveTo(x, y);
    });
    context.closePath();
  }

  points(shown, scale, ratio, style) {
    const { context } = this;
    const { spots } = this.descent;
    const moved = element("show-relaxed").checked;
    context.fillStyle = style.getPropertyValue("--points");
    for (const tile of shown) {
      const spot = tile.point && spots.get(tile.rank);
      if (!spot) continue;
      const edge = Math.hypot(...tile.edge) * scale;
      const [x, y] = moved && spot.moved ? spot.moved : [spot.x, spot.y];
      context.beginPath();
      context.arc(x * scale, y * scale, Math.min(5 * ratio, Math.max(0.9 * ratio, edge * 0.12)), 0, 2 * Math.PI);
      context.fill();
    }
  }

  // Where the keyboard's brush is.
  mark(scale, ratio, style) {
    if (!this.cursor || document.activeElement !== this.canvas) return;
    const { context } = this;
    const radius = (element("brush-size").valueAsNumber / 200) * SIDE * scale;
    context.beginPath();
    context.arc(this.cursor[0] * scale, this.cursor[1] * scale, radius, 0, 2 * Math.PI);
    context.strokeStyle = style.getPropertyValue("--points");
    context.lineWidth = 2 * ratio;
    context.setLineDash([6 * ratio, 4 * ratio]);
    context.stroke();
    context.setLineDash([]);
  }

  legend() {
    const hue = document.querySelector("[name=hue]:checked").value;
    const place = element("legend");
    if (place.dataset.hue === hue) return;
    place.dataset.hue = hue;
    const span = (className, text) => Object.assign(document.createElement("span"), { className, textContent: text });
    if (hue === "kind") {
      place.replaceChildren(...KINDS.flatMap((kind, i) => {
        const swatch = span("swatch", "");
        swatch.style.background = KIND_COLORS[i];
        return [swatch, span("", kind)];
      }));
    } else {
      const [low, high] = hue === "rank" ? ["first ranks", "last ranks"] : ["coarse", "fine"];
      const bar = span("ramp", "");
      bar.style.background = `linear-gradient(90deg, ${RAMP.map((c) => `rgb(${c})`)})`;
      place.replaceChildren(span("", low), bar, span("", high));
    }
  }

  // The smallest shown tile at a place of the painting.
  at(x, y) {
    if (!this.descent) return null;
    const deepest = this.descent.first + element("depth").valueAsNumber;
    let best = null;
    for (const tile of this.descent.list) {
      if (tile.level > deepest || (tile.opened && tile.level !== deepest)) continue;
      const away = Math.hypot(tile.x - x, tile.y - y) / Math.hypot(...tile.edge);
      if (away < 0.75 && (!best || away < best.away)) best = { tile, away };
    }
    return best?.tile ?? null;
  }

  describe(tile) {
    if (!tile) return "Nothing is looked at here: there is no ink.";
    const what = `${KINDS[tile.kind][0].toUpperCase()}${KINDS[tile.kind].slice(1)}, level ${tile.level}, rank ${tile.rank.toLocaleString("en")}`;
    if (tile.opened) return `${what}: open, since the ink here admits more than its own point.`;
    return tile.point ? `${what}: its point is there, the importance exceeds the rank.` : `${what}: waits for more ink.`;
  }

  // From the screen to the painting.
  place({ clientX, clientY }) {
    const box = this.canvas.getBoundingClientRect();
    return [((clientX - box.left) / box.width) * SIDE, ((clientY - box.top) / box.height) * SIDE];
  }

  listen() {
    const { canvas } = this;
    const erases = () => document.querySelector("[name=brush]:checked").value === "eraser";
    let down = null;
    canvas.addEventListener("pointerdown", (event) => {
      down = this.place(event);
      canvas.setPointerCapture(event.pointerId);
      this.cursor = null;
      this.dab(...down, erases());
    });
    canvas.addEventListener("pointermove", (event) => {
      const [x, y] = this.place(event);
      element("tile-now").textContent = this.describe(this.at(x, y));
      if (!down) return;
      // As if the brush had been everywhere between.
      const steps = Math.ceil(Math.hypot(x - down[0], y - down[1]) / 3);
      for (let i = 1; i <= steps; i++) {
        this.dab(down[0] + ((x - down[0]) * i) / steps, down[1] + ((y - down[1]) * i) / steps, erases());
      }
      if (steps) down = [x, y];
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (down = null));

    canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const step = (event.shiftKey ? 0.12 : 0.04) * SIDE;
      const move = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] }[event.key];
      this.cursor ??= [SIDE / 2, SIDE / 2];
      if (move) {
        this.cursor = this.cursor.map((t, i) => Math.min(SIDE, Math.max(0, t + move[i])));
        element("tile-now").textContent = this.describe(this.at(...this.cursor));
        this.draw();
      } else if (event.key === " " || event.key === "Enter") {
        this.dab(...this.cursor, erases());
      } else if (event.key.toLowerCase() === "e") {
        document.querySelector(`[name=brush][value=${erases() ? "ink" : "eraser"}]`).checked = true;
      } else {
        return;
      }
      event.preventDefault();
    });
    canvas.addEventListener("focus", () => this.draw());
    canvas.addEventListener("blur", () => this.draw());

    for (const id of ["richness", "tiles-seed"]) element(id).addEventListener("input", () => (this.tell(), this.changed()));
    for (const id of ["depth", "brush-size"]) element(id).addEventListener("input", () => (this.tell(), this.draw()));
    for (const id of ["show-tiles", "show-points", "show-relaxed"]) element(id).addEventListener("input", () => this.draw());
    for (const radio of document.querySelectorAll("[name=hue]")) radio.addEventListener("input", () => this.draw());
    for (const button of document.querySelectorAll("[data-painting]")) {
      button.addEventListener("click", () => this.paint(button.dataset.painting));
    }
    element("clear").addEventListener("click", () => this.paint("clear"));
    element("play").addEventListener("click", () => this.play());
  }

  // Opens the tiles level by level.
  async play() {
    const depth = element("depth");
    for (let level = 0; level <= Number(depth.max); level++) {
      depth.value = level;
      this.tell();
      this.draw();
      await new Promise((resolve) => setTimeout(resolve, 900));
      if (depth.valueAsNumber !== level) return;
    }
  }

  async show() {
    this.stars ??= await this.engine.ask("stars");
    this.draw();
  }
}

function ramp(part) {
  const place = Math.min(0.9999, Math.max(0, part)) * (RAMP.length - 1);
  const [low, high] = [RAMP[Math.floor(place)], RAMP[Math.floor(place) + 1]];
  const rest = place - Math.floor(place);
  return `rgb(${low.map((value, i) => Math.round(value + (high[i] - value) * rest))})`;
}
