// The camera: frames become dots as fast as the worker draws them. Dots stay where the picture does.
"use strict";

// The longer side of a frame, in pixels, and the dots that it gets if nobody says.
const FRAME_SIDE = 320;
const FRAME_DOTS = 6000;

class Camera {
  constructor(engine, settings, panes, drawing) {
    Object.assign(this, { engine, settings, panes, drawing });
    this.stream = null;
    this.facing = "user";
    this.video = document.createElement("video");
    this.video.muted = this.video.playsInline = true;
    this.canvas = document.createElement("canvas");
    this.context = this.canvas.getContext("2d", { willReadFrequently: true });
    element("camera").addEventListener("click", () => (this.stream ? this.stop() : this.start()));
    element("hold").addEventListener("click", () => this.hold());
    element("turn").addEventListener("click", () => {
      this.facing = this.facing === "user" ? "environment" : "user";
      this.start();
    });
  }

  get runs() {
    return this.stream !== null;
  }

  async start() {
    this.drawing.trouble("");
    this.unplug();
    try {
      if (!navigator.mediaDevices) throw new DOMException("", "SecurityError");
      const video = { facingMode: this.facing, width: { ideal: 640 } };
      this.stream = await navigator.mediaDevices.getUserMedia({ video });
      this.video.srcObject = this.stream;
      await this.video.play();
    } catch (error) {
      this.unplug();
      return this.drawing.trouble(reasonOf(error));
    }
    element("camera").textContent = "Camera off";
    element("camera-row").hidden = false;
    const devices = await navigator.mediaDevices.enumerateDevices();
    element("turn").hidden = devices.filter(({ kind }) => kind === "videoinput").length < 2;
    this.stream.getVideoTracks()[0].addEventListener("ended", () => this.stop());
    // Refining is not local: a change anywhere may move dots that nothing else moved.
    document.querySelector("[name=show][value=relaxed]").checked = true;
    this.settings.setUsual(FRAME_DOTS);
    this.panes.show(this.settings.modes);
    this.drawing.rest("The camera is on.");
    this.frames = 0;
    this.loop(this.stream);
  }

  async loop(stream) {
    let [since, frames] = [performance.now(), 0];
    while (this.stream === stream) {
      await new Promise(requestAnimationFrame);
      if (document.hidden || this.stream !== stream) continue;
      try {
        await this.frame();
      } catch (error) {
        this.drawing.trouble(`The camera's picture ${error.message}`);
      }
      this.frames += 1;
      frames += 1;
      const time = performance.now() - since;
      if (time > 3000 && this.stream === stream) {
        const rate = (1000 * frames) / time;
        this.drawing.status(`The camera is on: ${rate.toFixed(rate < 10 ? 1 : 0)} pictures a second.`);
        [since, frames] = [performance.now(), 0];
      }
    }
  }

  // The picture that the camera sees now.
  look() {
    const { videoWidth, videoHeight } = this.video;
    const shrink = Math.min(1, FRAME_SIDE / Math.max(videoWidth, videoHeight));
    const width = Math.max(1, Math.round(videoWidth * shrink));
    const height = Math.max(1, Math.round(videoHeight * shrink));
    if (this.canvas.width !== width || this.canvas.height !== height) {
      [this.canvas.width, this.canvas.height] = [width, height];
    }
    // As in a mirror, when it looks at the person.
    const mirrored = this.facing === "user";
    this.context.setTransform(mirrored ? -1 : 1, 0, 0, 1, mirrored ? width : 0, 0);
    this.context.drawImage(this.video, 0, 0, width, height);
    return { rgba: this.context.getImageData(0, 0, width, height).data, width, height };
  }

  async frame() {
    const { settings, panes, drawing } = this;
    const pixels = this.look();
    const { tones, modes, refine, seed } = settings;
    const mode = modes.at(-1);
    const dots = settings.dots ?? FRAME_DOTS;
    panes.show([mode]);
    await this.engine.ask(
      "frame",
      { pixels, settings: tones, mode, dots, seed, refine },
      [pixels.rgba.buffer],
      ({ about, places }) => {
        drawing.about = about;
        drawing.name = "camera";
        panes.fitTo(about.size);
        drawing.put(mode, places, tones.invert);
      },
    );
  }

  // Keeps what the camera sees now as the picture.
  hold() {
    const pixels = this.look();
    this.unplug();
    this.drawing.open({ pixels, name: "camera" });
  }

  stop() {
    if (!this.stream) return;
    this.unplug();
    if (this.drawing.source) {
      this.drawing.name = this.drawing.source.name;
      this.settings.setUsual(0);
      this.drawing.draw();
    } else {
      this.drawing.rest("The camera is off.");
    }
  }

  unplug() {
    for (const track of this.stream?.getTracks() ?? []) track.stop();
    this.stream = null;
    this.video.srcObject = null;
    element("camera").textContent = "Camera";
    element("camera-row").hidden = true;
    this.engine.ask("unplug");
  }
}

function reasonOf({ name, message }) {
  return {
    NotAllowedError: "The camera was not allowed. The browser's address bar has a switch for it.",
    NotFoundError: "There is no camera here.",
    NotReadableError: "The camera is in use by another program.",
    SecurityError: "Browsers give the camera only to pages with an https address, or from this computer.",
  }[name] ?? `The camera does not work: ${message}`;
}
