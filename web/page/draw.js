// The drawing: keeps what is shown in step with the picture and the settings.
"use strict";

class Drawing {
  constructor(engine, settings, panes) {
    Object.assign(this, { engine, settings, panes });
    this.source = null; // what was opened, in case the worker has to be replaced
    this.name = "";
    this.about = null;
    this.busy = 0;
    this.known = null; // the promise that a new worker knows the picture
    this.calm = window.matchMedia("(prefers-reduced-motion: reduce)");
    this.stopButton = element("stop");
    this.progress = element("progress");
    this.stopButton.addEventListener("click", () => this.stop());
    for (const button of document.querySelectorAll("[data-kind]")) {
      button.addEventListener("click", () => this.download(button.dataset.kind));
    }
  }

  status(text) {
    element("status").textContent = text;
  }

  trouble(text) {
    const alert = element("trouble");
    alert.textContent = text;
    alert.hidden = !text;
  }

  // Opens what has bytes or pixels, and a name.
  async open(source) {
    this.trouble("");
    this.working(`Reading ${source.name} …`);
    try {
      const opened = await this.reopen(source);
      if (!opened) return this.rest("Stopped.");
      [this.source, this.name] = [source, source.name];
      this.settings.setUsual(opened.dots);
      this.remarks = remarks(opened);
      this.rest("");
      await this.draw();
    } catch (error) {
      const reason = error.fatal
        ? "could not be read: it is damaged, or too large for this browser's memory."
        : error.message;
      this.trouble(`${source.name} ${reason}`);
      this.rest(this.source ? `Still showing ${this.name}.` : "");
      if (error.fatal) await this.draw();
    }
  }

  async reopen(source) {
    const bytes = source.blob && (await source.blob.arrayBuffer());
    const { name, pixels } = source;
    return this.engine.ask("open", { bytes, pixels, name, settings: this.settings.tones }, bytes ? [bytes] : []);
  }

  // Draws the picture anew.
  async draw() {
    if (!this.source) return;
    const { settings, panes } = this;
    const { tones, modes, dots, refine, seed } = settings;
    const inverted = tones.invert;
    panes.show(modes);
    this.working("");
    const counts = {};
    let time = 0;
    const heard = ({ mode, step, of, about, places, milliseconds }) => {
      this.about = about;
      panes.fitTo(about.size);
      if (settings.usual) settings.setUsual(about.usual);
      if (step !== undefined) {
        this.progress.value = step / of;
        if (step === 0) this.status(`Refining ${plural(about.dots, "dot", "dots")} …`);
      }
      if (milliseconds !== undefined) {
        counts[mode] = places.length / 2;
        time += milliseconds;
      }
      if (places) this.put(mode, places, inverted);
    };
    const number = ++this.busy;
    try {
      await this.known;
      const watched = !this.calm.matches;
      const done = await this.engine.ask(
        "draw",
        { settings: tones, modes, dots, seed, refine, watched },
        [],
        (said) => number === this.busy && heard(said),
      );
      if (number !== this.busy) return;
      this.rest(done ? this.summary(counts, time, done.cut ?? null) : "Stopped.");
    } catch (error) {
      if (number !== this.busy) return;
      this.trouble(`${this.name} ${error.message || "needs more memory than this browser gives."}`);
      this.rest("");
    }
  }

  // Shows dots.
  put(mode, places, inverted) {
    const pane = this.panes.pane(mode);
    if (!pane) return;
    const diameter = this.about.dotSize * this.settings.size;
    pane.draw({ places, diameter, inverted });
    pane.canvas.setAttribute("aria-label", `${this.name || "The picture"} as ${plural(places.length / 2, "dot", "dots")}, ${mode}`);
  }

  // The same dots in another size.
  look() {
    if (!this.about) return;
    for (const pane of this.panes.panes) {
      if (pane.dots) pane.draw({ ...pane.dots, diameter: this.about.dotSize * this.settings.size });
    }
  }

  summary(counts, time, cut) {
    const modes = Object.keys(counts);
    const dots = modes.length === 1
      ? plural(counts[modes[0]], "dot", "dots")
      : modes.map((mode) => `${counts[mode].toLocaleString("en")} ${mode}`).join(", ");
    const seconds = time < 9.5 ? `${Math.round(time)} ms` : `${(time / 1000).toFixed(2)} s`;
    const stopped = cut === null ? [] : [`Stopped after ${cut} of ${this.settings.refine}.`];
    return [`${dots}, in ${seconds}.`, ...stopped, ...(this.remarks ?? [])].join(" ");
  }

  working(text) {
    if (text) this.status(text);
    this.progress.removeAttribute("value");
    this.progress.hidden = this.stopButton.hidden = false;
    document.body.setAttribute("aria-busy", "true");
  }

  rest(text) {
    const focused = document.activeElement === this.stopButton;
    this.progress.hidden = this.stopButton.hidden = true;
    if (focused) element("controls").querySelector("input").focus();
    document.body.removeAttribute("aria-busy");
    if (text) this.status(text);
  }

  async stop() {
    await this.engine.stop();
  }

  // A new worker knows no picture.
  restarted() {
    if (this.source) this.known = this.reopen(this.source);
  }

  async download(kind) {
    const mode = this.settings.modes.at(-1);
    const pane = this.panes.pane(mode);
    if (!pane?.dots) return this.trouble("There is no drawing to download yet.");
    const size = this.settings.size;
    const dotSize = size === 1 ? 0 : this.about.dotSize * size;
    const scale = kind === "png" ? this.settings.scale : 1;
    try {
      const bytes = await this.engine.ask("file", { mode, kind, title: this.name, dotSize, scale });
      const type = { svg: "image/svg+xml", png: "image/png", csv: "text/csv" }[kind];
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([bytes], { type }));
      link.download = `${this.name.replace(/\.[^.]*$/, "") || "dots"}.${kind}`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 60000);
      this.status(`${link.download} is written.`);
    } catch (error) {
      this.trouble(`The ${kind.toUpperCase()} file ${error.message || "needs more memory than this browser gives"}`);
    }
  }
}

// What a person should know about a picture that was opened.
function remarks({ width, height, whole, warnings }) {
  const made = [];
  if (whole[0] !== width || whole[1] !== height) {
    made.push(`The picture of ${whole[0]} × ${whole[1]} pixels was made smaller, ${width} × ${height}, for this page.`);
  }
  return made.concat(warnings.map((warning) => `${warning[0].toUpperCase()}${warning.slice(1)}.`));
}
