// How long things take in Chromium: node times.mjs
import { PHOTOGRAPH, browser, drop, opened, redrawn, serve } from "./common.mjs";

const server = await serve();
const chromium = await browser(["--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream"]);
const context = await chromium.newContext({ permissions: ["camera"], reducedMotion: "reduce" });

const began = performance.now();
const page = await opened(context, server.address);
console.log(`from the address to the first drawing: ${Math.round(performance.now() - began)} ms`);

await redrawn(page, () => drop(page, PHOTOGRAPH));
const choose = (mode) => page.check(`[name=show][value=${mode}]`, { force: true });
for (const dots of [10000, 100000]) {
  for (const mode of ["fixed", "relaxed", "refined"]) {
    const status = [];
    await choose(mode);
    for (let i = 0; i < 3; i++) {
      await redrawn(page, () => page.fill("#dots-number", String(dots + i)));
      const [, number, unit] = (await page.textContent("#status")).match(/in ([\d.]+) (m?s)/);
      status.push(number * (unit === "s" ? 1000 : 1));
    }
    console.log(`${dots} dots, ${mode}: ${Math.min(...status)} ms, the least of three`);
  }
}
for (const mode of ["relaxed", "refined"]) {
  await page.click("#camera");
  await choose(mode);
  await page.waitForTimeout(8000);
  console.log(`camera, ${mode}: ${await page.textContent("#status")}`);
  await page.click("#camera");
}
await chromium.close();
server.close();
