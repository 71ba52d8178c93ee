// The worker seen from the page: a question, an answer, and what is said in between.
"use strict";

// How long a worker has to heed a stop before it is replaced.
const PATIENCE = 600;

class Engine {
  constructor(onTrouble) {
    this.onTrouble = onTrouble;
    this.start();
  }

  start() {
    this.asked = new Map();
    this.next = 1;
    const address = URL.createObjectURL(new Blob([PACKED.worker], { type: "text/javascript" }));
    this.worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.worker.onmessage = ({ data }) => this.hear(data);
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.fail(event.message || "The worker could not be started.");
    };
    const engine = bytesOf(PACKED.engine);
    this.ready = this.ask("load", { engine }, [engine]);
    this.ready.catch((error) => this.fail(error.message));
  }

  // Asks for a task; `onSaid` hears what comes before its result.
  ask(task, data = {}, transfer = [], onSaid = () => {}) {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      this.asked.set(id, { resolve, reject, onSaid });
      this.worker.postMessage({ id, task, data }, transfer);
    });
  }

  hear({ id, said, result, error, fatal }) {
    const asked = this.asked.get(id);
    if (!asked) return;
    if (said !== undefined) return asked.onSaid(said);
    this.asked.delete(id);
    if (error === undefined) return asked.resolve(result);
    const failure = new Error(error);
    failure.fatal = fatal;
    if (fatal) this.restart();
    asked.reject(failure);
  }

  // A new worker in place of this one, which forgets all that it was asked and told.
  restart() {
    this.worker.terminate();
    const asked = this.asked;
    this.start();
    for (const { resolve } of asked.values()) resolve(null);
    this.onRestart?.();
  }

  // Stops a drawing: between two steps if it gets there soon, else the hard way.
  async stop() {
    const worker = this.worker;
    const timer = setTimeout(() => {
      if (worker === this.worker) this.restart();
    }, PATIENCE);
    await this.ask("stop");
    clearTimeout(timer);
  }

  fail(reason) {
    this.onTrouble(`The engine does not run here. ${reason}`);
  }
}

// What `web/pack` writes for bytes: their number, and for four of them five digits to the base of 85.
const DIGITS = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.-:+=^!/*?&<>()[]{}@%$#";

function bytesOf(packed) {
  const values = new Uint8Array(128);
  for (let i = 0; i < 85; i++) values[DIGITS.charCodeAt(i)] = i;
  const start = packed.indexOf(" ") + 1;
  const length = Number(packed.slice(0, start));
  const words = new DataView(new ArrayBuffer(4 * Math.ceil(length / 4)));
  for (let i = start, at = 0; i < packed.length; at += 4) {
    let word = 0;
    for (const end = i + 5; i < end; i++) word = 85 * word + values[packed.charCodeAt(i)];
    words.setUint32(at, word);
  }
  return words.buffer.slice(0, length);
}
