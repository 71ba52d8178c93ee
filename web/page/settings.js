// What the sliders say.
"use strict";

const FEWEST_DOTS = 100;
const MOST_SLIDER_DOTS = 200000;

const element = (id) => document.getElementById(id);

const plural = (count, one, many) => `${count.toLocaleString("en")} ${count === 1 ? one : many}`;

class Settings {
  constructor(onChange, onLook) {
    this.usual = true; // as many dots as the picture gets if nobody says
    const changed = () => {
      this.tell();
      onChange();
    };
    element("dots").addEventListener("input", () => {
      this.usual = false;
      element("dots-number").value = this.sliderDots();
      changed();
    });
    element("dots-number").addEventListener("input", () => {
      const number = element("dots-number");
      if (!number.checkValidity() || number.value === "") return;
      this.usual = false;
      this.setSlider(number.valueAsNumber);
      changed();
    });
    element("dots-number").addEventListener("change", () => {
      const number = element("dots-number");
      const dots = Math.min(1e6, Math.max(1, Math.round(number.valueAsNumber || 1)));
      if (String(dots) !== number.value) {
        this.usual = false;
        number.value = dots;
        this.setSlider(dots);
        changed();
      }
    });
    for (const id of ["refine", "seed", "invert", "linear", "gain"]) {
      element(id).addEventListener("input", changed);
    }
    element("size").addEventListener("input", () => {
      this.tell();
      onLook();
    });
    element("scale").addEventListener("input", () => this.tell());
    element("another").addEventListener("click", () => {
      element("seed").value = (element("seed").valueAsNumber + 1) % 100;
      changed();
    });
    for (const radio of document.querySelectorAll("[name=show]")) {
      radio.addEventListener("input", changed);
    }
    this.tell();
  }

  get tones() {
    const [linear, invert, gain] = ["linear", "invert", "gain"].map((id) => element(id).checked);
    return { linear, invert, gain };
  }

  get modes() {
    const shown = document.querySelector("[name=show]:checked").value;
    return shown === "all" ? ["fixed", "relaxed", "refined"] : [shown];
  }

  // Null for the usual number.
  get dots() {
    return this.usual ? null : element("dots-number").valueAsNumber;
  }

  get refine() {
    return element("refine").valueAsNumber;
  }

  get seed() {
    return element("seed").valueAsNumber;
  }

  // Of the usual diameter.
  get size() {
    return element("size").valueAsNumber / 100;
  }

  get scale() {
    return element("scale").valueAsNumber;
  }

  sliderDots() {
    const part = element("dots").valueAsNumber / 1000;
    const dots = FEWEST_DOTS * (MOST_SLIDER_DOTS / FEWEST_DOTS) ** part;
    const step = 10 ** (Math.floor(Math.log10(dots)) - 1);
    return Math.round(dots / step) * step;
  }

  setSlider(dots) {
    const part = Math.log(dots / FEWEST_DOTS) / Math.log(MOST_SLIDER_DOTS / FEWEST_DOTS);
    element("dots").value = 1000 * Math.min(1, Math.max(0, part));
    this.tell();
  }

  // What a new picture or camera begins with.
  setUsual(dots) {
    this.usual = true;
    element("dots-number").value = dots;
    this.setSlider(dots);
  }

  tell() {
    const say = (id, text) => {
      element(`${id}-now`).textContent = text;
      element(id).setAttribute("aria-valuetext", text);
    };
    say("size", `${element("size").value} %`);
    say("refine", this.refine === 0 ? "not at all" : plural(this.refine, "time", "times"));
    say("scale", `${this.scale} ×`);
    element("dots").setAttribute("aria-valuetext", `${element("dots-number").value} dots`);
  }
}
