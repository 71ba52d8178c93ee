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

// What `web/pack` writes for bytes: their number, a space, and their bits: a character below 128 stands for seven of
// them, one above for fourteen, of which the first seven are a character that no string holds as it is.
const ELSEWHERE = [0, 10, 13, 34, 92];

function bytesOf(packed) {
  const start = packed.indexOf(" ") + 1;
  const bytes = new Uint8Array(Number(packed.slice(0, start)));
  let bits = 0;
  let held = 0;
  let at = 0;
  const take = (value) => {
    bits = ((bits << 7) | value) & 0x3fff;
    held += 7;
    if (held >= 8) bytes[at++] = bits >> (held -= 8);
  };
  for (let i = start; i < packed.length; i++) {
    const code = packed.charCodeAt(i);
    if (code >= 128) take(ELSEWHERE[(code >> 7) - 1]);
    take(code & 127);
  }
  return bytes.buffer;
}
