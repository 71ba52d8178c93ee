// Panes: canvases of dots that are zoomed and moved together. Dots are drawn a few thousand at a time, on a canvas
// that nobody sees, so that the page stays at hand however many there are.
"use strict";

const CAPTIONS = {
  fixed: "Fixed: at the centers of tiles",
  relaxed: "Relaxed: moved aside by a table",
  refined: "Refined: moved until they draw the picture",
};

const MOST_ZOOM = 64;

// Milliseconds of drawing between two looks at what the person does.
const SLICE = 8;

class Panes {
  constructor(place, onZoom) {
    this.place = place;
    this.onZoom = onZoom;
    this.panes = [];
    this.view = { zoom: 1, x: 0.5, y: 0.5 }; // the picture's place in the middle of a pane, from 0 to 1
    this.size = [1, 1];
    new ResizeObserver(() => this.redraw()).observe(place);
  }

  // The panes of these modes, those that there were kept.
  show(modes) {
    if (this.panes.map((pane) => pane.mode).join() === modes.join()) return;
    const old = new Map(this.panes.map((pane) => [pane.mode, pane]));
    this.panes = modes.map((mode) => old.get(mode) ?? new Pane(this, mode));
    this.place.replaceChildren(...this.panes.map((pane) => pane.figure));
    this.place.classList.toggle("one", modes.length === 1);
    for (const pane of this.panes) pane.caption.hidden = modes.length === 1;
    this.redraw();
  }

  pane(mode) {
    return this.panes.find((pane) => pane.mode === mode);
  }

  // The picture's size; another one is shown whole.
  fitTo(size) {
    if (this.size.join() === size.join()) return;
    this.size = size;
    this.place.style.setProperty("--across", size[0]);
    this.place.style.setProperty("--down", size[1]);
    this.fit();
  }

  fit() {
    this.move({ zoom: 1, x: 0.5, y: 0.5 });
  }

  // Zooms by a factor about a place of the picture, which stays where it is.
  zoom(factor, [x, y] = [this.view.x, this.view.y]) {
    const zoom = Math.min(MOST_ZOOM, Math.max(1, this.view.zoom * factor));
    const rest = this.view.zoom / zoom;
    this.move({ zoom, x: x + (this.view.x - x) * rest, y: y + (this.view.y - y) * rest });
  }

  move({ zoom, x, y }) {
    const half = 0.5 / zoom;
    const within = (t) => Math.min(1 - half, Math.max(half, t));
    this.view = { zoom, x: within(x), y: within(y) };
    this.place.classList.toggle("zoomed", zoom > 1);
    this.onZoom(zoom);
    this.redraw();
  }

  redraw() {
    for (const pane of this.panes) pane.redraw();
  }
}

class Pane {
  constructor(panes, mode) {
    this.panes = panes;
    this.mode = mode;
    this.dots = null;
    this.figure = document.createElement("figure");
    this.figure.className = "pane";
    this.canvas = document.createElement("canvas");
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "No picture yet");
    this.canvas.dataset.mode = mode;
    this.caption = document.createElement("figcaption");
    this.caption.textContent = CAPTIONS[mode];
    this.figure.append(this.canvas, this.caption);
    this.hidden = document.createElement("canvas");
    this.drawing = 0;
    listen(this);
  }

  // Dots (x and y of each), the diameter of one, and whether they are white.
  draw(dots) {
    this.dots = dots;
    this.redraw();
  }

  redraw() {
    if (!this.dots || !this.canvas.isConnected) return;
    const ratio = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.hidden.width !== width || this.hidden.height !== height) {
      [this.hidden.width, this.hidden.height] = [width, height];
    }
    const { zoom, x, y } = this.panes.view;
    const [across, down] = this.panes.size;
    const scale = Math.min(width / across, height / down) * zoom;
    const left = width / 2 - x * across * scale;
    const top = height / 2 - y * down * scale;
    const mine = ++this.drawing;
    const strokes = dotsOn(this.hidden, this.dots, { scale, left, top, across, down });
    const slice = () => {
      if (mine !== this.drawing) return;
      const end = performance.now() + SLICE;
      while (performance.now() < end) {
        if (strokes.next().done) return this.publish();
      }
      requestAnimationFrame(slice);
    };
    slice();
  }

  publish() {
    if (this.canvas.width !== this.hidden.width) this.canvas.width = this.hidden.width;
    if (this.canvas.height !== this.hidden.height) this.canvas.height = this.hidden.height;
    const context = this.canvas.getContext("2d");
    context.globalCompositeOperation = "copy";
    context.drawImage(this.hidden, 0, 0);
  }
}

// Draws dots on a canvas, in pieces.
function* dotsOn(canvas, { places, diameter, inverted }, { scale, left, top, across, down }) {
  const context = canvas.getContext("2d");
  const [ground, ink] = inverted ? ["#000", "#fff"] : ["#fff", "#000"];
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.save();
  context.beginPath();
  context.rect(left, top, across * scale, down * scale);
  context.clip();
  context.fillStyle = ground;
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = ink;
  const radius = (diameter * scale) / 2;
  const [right, bottom] = [canvas.width + radius, canvas.height + radius];
  const piece = 2000;
  try {
    for (let i = 0; i < places.length; ) {
      const end = Math.min(places.length, i + piece);
      context.beginPath();
      for (; i < end; i += 2) {
        const x = left + places[i] * scale;
        const y = top + places[i + 1] * scale;
        if (x < -radius || y < -radius || x > right || y > bottom) continue;
        if (radius < 0.7) {
          const side = radius * Math.sqrt(Math.PI);
          context.rect(x - side / 2, y - side / 2, side, side);
        } else {
          context.moveTo(x + radius, y);
          context.arc(x, y, radius, 0, 2 * Math.PI);
        }
      }
      context.fill();
      yield;
    }
  } finally {
    context.restore();
  }
}

// What a person does with a pane.
function listen(pane) {
  const { canvas, panes } = pane;
  const touches = new Map();

  // The place of the picture under a point of the screen.
  const place = ({ clientX, clientY }) => {
    const box = canvas.getBoundingClientRect();
    const [across, down] = panes.size;
    const scale = Math.min(box.width / across, box.height / down) * panes.view.zoom;
    return [
      panes.view.x + (clientX - box.left - box.width / 2) / (across * scale),
      panes.view.y + (clientY - box.top - box.height / 2) / (down * scale),
    ];
  };

  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && panes.view.zoom === 1 && document.activeElement !== canvas) return;
    event.preventDefault();
    panes.zoom(Math.exp(-event.deltaY / (event.ctrlKey ? 120 : 400)), place(event));
  }, { passive: false });

  canvas.addEventListener("dblclick", (event) => panes.zoom(event.shiftKey ? 0.5 : 2, place(event)));

  canvas.addEventListener("pointerdown", (event) => {
    touches.set(event.pointerId, event);
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = touches.get(event.pointerId);
    if (!before) return;
    const others = [...touches.values()].filter((touch) => touch.pointerId !== event.pointerId);
    touches.set(event.pointerId, event);
    if (others.length === 1) {
      const apart = (a, b) => Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
      panes.zoom(apart(event, others[0]) / Math.max(1, apart(before, others[0])), place(others[0]));
    } else if (panes.view.zoom > 1) {
      const [from, to] = [place(before), place(event)];
      const { zoom, x, y } = panes.view;
      panes.move({ zoom, x: x + from[0] - to[0], y: y + from[1] - to[1] });
    }
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) => touches.delete(event.pointerId));
  }

  canvas.addEventListener("keydown", (event) => {
    const { zoom, x, y } = panes.view;
    const step = 0.2 / zoom;
    const keys = {
      "+": () => panes.zoom(1.5),
      "=": () => panes.zoom(1.5),
      "-": () => panes.zoom(1 / 1.5),
      0: () => panes.fit(),
      ArrowLeft: () => panes.move({ zoom, x: x - step, y }),
      ArrowRight: () => panes.move({ zoom, x: x + step, y }),
      ArrowUp: () => panes.move({ zoom, x, y: y - step }),
      ArrowDown: () => panes.move({ zoom, x, y: y + step }),
    };
    if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    if (zoom === 1 && event.key.startsWith("Arrow")) return;
    event.preventDefault();
    keys[event.key]();
  });
}
