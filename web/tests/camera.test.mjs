// The camera: Chromium's own test picture, and a film in which half of the picture stays.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { FOLDER_ADDRESS, browser, download, drawn, folder, opened, serve } from "./common.mjs";

let server;
const FAKE = ["--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream"];

before(async () => (server = await serve()));
after(() => server?.close());

async function filming(args, work, address = server.address) {
  const chromium = await browser(args);
  try {
    const page = await opened(await chromium.newContext({ permissions: ["camera"] }), address);
    await page.click("#camera");
    await page.waitForFunction(() => /pictures a second/.test(document.getElementById("status").textContent), null, { timeout: 60000 });
    await work(page);
    assert.deepEqual(page.complaints, []);
  } finally {
    await chromium.close();
  }
}

async function dots(page) {
  const csv = (await download(page, "csv")).bytes.toString().trim().split("\n").slice(1);
  return csv.map((line) => line.split(",").map(Number));
}

test("frames are drawn as they come; one is kept; the camera goes off", () =>
  filming(FAKE, async (page) => {
    const first = await dots(page);
    await page.waitForTimeout(1500);
    const second = await dots(page);
    assert.ok(first.length > 4500 && first.length < 7500, `${first.length} dots`);
    assert.notDeepEqual(first, second);
    assert.match(await page.getAttribute("#panes canvas", "aria-label"), /camera as [\d,]+ dots/);
    await page.click("#hold");
    await drawn(page);
    assert.equal(await page.textContent("#camera"), "Camera");
    assert.ok(await page.isHidden("#camera-row"));
    const kept = await dots(page);
    await page.waitForTimeout(500);
    assert.deepEqual(await dots(page), kept);
  }));

test("dots stay where the picture does, though the camera's sensor is noisy", async () => {
  const film = join(folder, "film.y4m");
  writeFileSync(film, noisyFilm(320, 240, 40));
  await filming([...FAKE, `--use-file-for-fake-video-capture=${film}`], async (page) => {
    for (const mode of ["relaxed", "refined"]) {
      await page.check(`[name=show][value=${mode}]`, { force: true });
      await page.waitForTimeout(2500);
      const before = await dots(page);
      await page.waitForTimeout(1500);
      const now = await dots(page);
      // The page mirrors: what stays is on the left.
      const still = before.filter(([x]) => x < 0.45 * 320);
      const spacing = Math.sqrt((320 * 240) / before.length);
      const stayed = still.filter((dot) => nearest(dot, now) < spacing / 10).length;
      const moving = before.filter(([x]) => x > 0.55 * 320);
      const changed = moving.filter((dot) => nearest(dot, now) > spacing / 10).length;
      console.log(`${mode}: ${stayed} of ${still.length} dots stayed, ${changed} of ${moving.length} elsewhere moved`);
      const enough = mode === "relaxed" ? 0.99 : 0.6;
      assert.ok(still.length > 1000 && stayed > enough * still.length, `${mode}: ${stayed} of ${still.length}`);
      assert.ok(changed > 0.05 * moving.length, `${mode}: ${changed} of ${moving.length}`);
    }
  });
});

test("it works from a folder too", () =>
  filming(FAKE, async (page) => assert.ok((await dots(page)).length > 4500), FOLDER_ADDRESS));

test("without a camera it says so", async () => {
  const chromium = await browser(["--use-fake-ui-for-media-stream"]);
  try {
    const page = await opened(await chromium.newContext(), server.address);
    await page.click("#camera");
    await page.waitForSelector("#trouble:not([hidden])");
    assert.match(await page.textContent("#trouble"), /camera/);
  } finally {
    await chromium.close();
  }
});

function nearest([x, y], dots) {
  return dots.reduce((least, [u, v]) => Math.min(least, Math.hypot(u - x, v - y)), Infinity);
}

// A YUV film: a gradient with noise, and on its left half a dark bar that walks.
function noisyFilm(width, height, frames) {
  const parts = [`YUV4MPEG2 W${width} H${height} F20:1 Ip A1:1 C420jpeg\n`];
  let state = 1;
  const noise = () => ((state = (state * 1103515245 + 12345) & 0x7fffffff) >> 16) % 9 - 4;
  for (let frame = 0; frame < frames; frame++) {
    const luma = Buffer.alloc(width * height);
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        const bar = x < width / 2 && Math.abs(x - (20 + (frame * 3) % 120)) < 14;
        luma[y * width + x] = (bar ? 30 : 90 + (y * 110) / height) + noise();
      }
    }
    parts.push("FRAME\n", luma, Buffer.alloc((width * height) / 2, 128));
  }
  return Buffer.concat(parts.map((part) => Buffer.from(part)));
}
