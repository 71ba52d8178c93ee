// Ways for a picture to come in: a dialog, a drop, the clipboard, a sample.
"use strict";

const SAMPLES = [
  { name: "photographer.jpg", title: "A photographer with a camera on a tripod" },
  { name: "cat.jpg", title: "A cat's face" },
  { name: "cup.jpg", title: "A cup of coffee" },
];

class Intake {
  constructor(onSource) {
    this.onSource = onSource;
    this.dialog();
    this.drops();
    this.clipboard();
    this.samples();
  }

  take(file) {
    if (file) this.onSource({ blob: file, name: file.name || "The picture" });
  }

  dialog() {
    const input = element("file");
    input.addEventListener("change", () => {
      this.take(input.files[0]);
      input.value = ""; // the same file may be chosen again
    });
  }

  drops() {
    const overlay = element("drop");
    let depth = 0;
    const over = (change) => {
      depth = Math.max(0, depth + change);
      overlay.hidden = depth === 0;
    };
    const files = (event) => event.dataTransfer?.types.includes("Files");
    document.addEventListener("dragenter", (event) => files(event) && over(1));
    document.addEventListener("dragleave", (event) => files(event) && over(-1));
    document.addEventListener("dragover", (event) => files(event) && event.preventDefault());
    document.addEventListener("drop", (event) => {
      if (!files(event)) return;
      event.preventDefault();
      over(-depth);
      this.take(event.dataTransfer.files[0]);
    });
  }

  clipboard() {
    document.addEventListener("paste", (event) => {
      const file = event.clipboardData?.files[0];
      if (file) this.take(file);
    });
  }

  samples() {
    for (const { name, title } of SAMPLES) {
      const button = document.createElement("button");
      button.type = "button";
      const picture = document.createElement("img");
      picture.src = URL.createObjectURL(blobOf(name));
      picture.alt = title;
      button.append(picture);
      button.addEventListener("click", () => this.sample(name));
      element("samples").append(button);
    }
  }

  sample(name) {
    this.onSource({ blob: blobOf(name), name });
  }
}

function blobOf(name) {
  return new Blob([bytesOf(PACKED.samples[name])], { type: "image/jpeg" });
}
