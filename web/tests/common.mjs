// What the tests share: a server of the page's folder, a browser, and the program to compare with.
import { execFileSync } from "node:child_process";
import { createServer } from "node:http";
import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const ROOT = fileURLToPath(new URL("../..", import.meta.url));
export const DIST = join(ROOT, "web/dist");
export const PHOTOGRAPH = join(ROOT, "examples/photographs/camera.png");

const PROGRAM = process.env.TWELVEFOLD_PROGRAM ?? join(ROOT, "target/debug/twelvefold");
const CHROMIUM = process.env.CHROMIUM ?? "/usr/bin/chromium";

// Without these, Chromium calls home.
const QUIET = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };

// The page as a plain server hands it out.
export async function serve() {
  const server = createServer((request, response) => {
    const name = request.url === "/" ? "/index.html" : request.url;
    try {
      const body = readFileSync(join(DIST, name));
      response.writeHead(200, { "content-type": TYPES[extname(name)] ?? "application/octet-stream" });
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

export const FOLDER_ADDRESS = pathToFileURL(join(DIST, "index.html")).href;

export function browser(more = []) {
  return chromium.launch({ executablePath: CHROMIUM, args: [...QUIET, ...more] });
}

export const folder = mkdtempSync(join(tmpdir(), "twelvefold-web-"));

// What the program writes for a file, as bytes.
export function program(photograph, kind, options = []) {
  const output = join(folder, `program.${kind}`);
  execFileSync(PROGRAM, ["stipple", photograph, "-o", output, "--quiet", ...options.map(String)]);
  return readFileSync(output);
}

// The page, when it has drawn its first picture. Anything that it says on its console is an error.
export async function opened(context, address) {
  const page = await context.newPage();
  page.complaints = [];
  page.on("console", (message) => page.complaints.push(message.text()));
  page.on("pageerror", (error) => page.complaints.push(String(error)));
  page.asked = [];
  page.on("request", (request) => page.asked.push(request.url()));
  await page.goto(address);
  await drawn(page);
  return page;
}

// Waits until nothing is being drawn, and returns what the page says.
export async function drawn(page) {
  await page.waitForFunction(
    () => !document.body.hasAttribute("aria-busy") && /dots?, in|dots? ?fixed|fixed,/.test(document.getElementById("status").textContent),
    null,
    { timeout: 120000 },
  );
  return page.textContent("#status");
}

// Waits for a new drawing that an action brings.
export async function redrawn(page, action) {
  await page.evaluate(() => (document.getElementById("status").textContent = "waiting"));
  await action();
  return drawn(page);
}

// Drops a file on the page, as from a folder.
export async function drop(page, path, name) {
  const bytes = readFileSync(path).toString("base64");
  await dropBytes(page, bytes, name ?? path.split("/").pop());
}

export async function dropBytes(page, base64, name) {
  await page.evaluate(
    ([base64, name]) => {
      const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      const data = new DataTransfer();
      data.items.add(new File([bytes], name));
      for (const type of ["dragenter", "dragover", "drop"]) {
        const event = new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true });
        document.getElementById("main").dispatchEvent(event);
      }
    },
    [base64, name],
  );
}

// The file that a button downloads.
export async function download(page, kind) {
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.click(`[data-kind=${kind}]`),
  ]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

// Dots in an SVG file: each begins with a move.
export function dotsIn(svg) {
  return svg.toString().split("\nm").length - 1 + svg.toString().split('d="M').length - 1;
}
