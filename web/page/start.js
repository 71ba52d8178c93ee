// Puts the parts together.
"use strict";

(() => {
  const missing = ["WebAssembly", "Worker", "DecompressionStream", "ResizeObserver"].filter((name) => !(name in window));
  const trouble = (text) => {
    element("trouble").textContent = text;
    element("trouble").hidden = false;
  };
  if (missing.length) {
    trouble(`This browser is too old for this page; it lacks ${missing.join(", ")}.`);
    element("status").textContent = "";
    return;
  }

  const engine = new Engine(trouble);
  const panes = new Panes(element("panes"), (zoom) => {
    element("zoom-now").textContent = `${Math.round(100 * zoom)} %`;
  });
  let camera = null;
  let drawing = null;
  // A slider that is dragged says more than can be drawn: the last word of a frame counts.
  let due = false;
  const changed = () => {
    if (due) return;
    due = true;
    requestAnimationFrame(() => {
      due = false;
      if (!camera.runs) drawing.draw();
    });
  };
  const settings = new Settings(changed, () => drawing.look());
  drawing = new Drawing(engine, settings, panes);
  camera = new Camera(engine, settings, panes, drawing);
  engine.onRestart = () => drawing.restarted();
  panes.show(settings.modes);

  element("zoom-in").addEventListener("click", () => panes.zoom(1.5));
  element("zoom-out").addEventListener("click", () => panes.zoom(1 / 1.5));
  element("zoom-fit").addEventListener("click", () => panes.fit());

  const intake = new Intake((source) => {
    if (camera.runs) camera.unplug();
    select("draw");
    drawing.open(source);
  });

  let tiles = null;
  const tabs = ["draw", "tiles"];
  function select(name) {
    for (const tab of tabs) {
      const chosen = tab === name;
      element(`tab-${tab}`).setAttribute("aria-selected", chosen);
      element(`tab-${tab}`).tabIndex = chosen ? 0 : -1;
      element(`view-${tab}`).hidden = !chosen;
    }
    document.title = name === "draw" ? "twelvefold: photographs as dots" : "twelvefold: how it works";
    if (name === "tiles") {
      tiles ??= new Tiles(engine);
      tiles.show();
    }
  }
  tabs.forEach((name, i) => {
    element(`tab-${name}`).addEventListener("click", () => select(name));
    element(`tab-${name}`).addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!step) return;
      const next = tabs[(i + step + tabs.length) % tabs.length];
      select(next);
      element(`tab-${next}`).focus();
    });
  });

  element("controls").addEventListener("submit", (event) => event.preventDefault());
  intake.sample(SAMPLES[0].name);
})();
