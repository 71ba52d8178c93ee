// The view that teaches.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { browser, opened, serve } from "./common.mjs";

let server, chromium, context;

before(async () => {
  server = await serve();
  chromium = await browser();
  context = await chromium.newContext({ reducedMotion: "reduce" });
});

after(async () => {
  await chromium?.close();
  server?.close();
});

async function fresh() {
  const page = await opened(context, server.address);
  await page.click("#tab-tiles");
  await settled(page);
  return page;
}

// Points, opened tiles and tiles looked at.
async function settled(page) {
  await page.waitForTimeout(250);
  const text = await page.waitForFunction(() => /looked at/.test(document.getElementById("tiles-status").textContent) && document.getElementById("tiles-status").textContent);
  const [points, opened, looked] = (await text.jsonValue()).replaceAll(",", "").match(/\d+/g).map(Number);
  return { points, opened, looked };
}

test("ink opens tiles and brings points, and without ink nothing is looked at", async () => {
  const page = await fresh();
  const spot = await settled(page);
  assert.ok(spot.points > 100 && spot.opened > 10 && spot.looked > spot.points);
  await page.click("#clear");
  const none = await settled(page);
  assert.deepEqual(none, { points: 0, opened: 0, looked: 0 });

  const box = await page.locator("#tiles").boundingBox();
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(0.3, 0.5));
  await page.mouse.down();
  await page.mouse.move(...at(0.7, 0.5), { steps: 12 });
  await page.mouse.up();
  const stroke = await settled(page);
  assert.ok(stroke.points > 20 && stroke.opened > 5, JSON.stringify(stroke));

  await page.fill("#richness", "85");
  const rich = await settled(page);
  assert.ok(rich.points > 1.5 * stroke.points && rich.opened > stroke.opened);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("it can be painted with the keyboard", async () => {
  const page = await fresh();
  await page.click("#clear");
  await page.focus("#tiles");
  for (const key of ["ArrowLeft", "ArrowUp", "Space", "Space", "Space", "Space"]) await page.keyboard.press(key);
  const painted = await settled(page);
  assert.ok(painted.points > 0);
  await page.keyboard.press("e");
  assert.ok(await page.isChecked("[name=brush][value=eraser]"));
  for (let i = 0; i < 8; i++) await page.keyboard.press("Enter");
  assert.ok((await settled(page)).points < painted.points);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test("a tile tells its type, level and rank; colors and levels change what is seen", async () => {
  const page = await fresh();
  const box = await page.locator("#tiles").boundingBox();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.4 * box.height);
  assert.match(await page.textContent("#tile-now"), /(Hexagon|Pentagon) [abcd], level \d+, rank [\d,]+/);
  const look = () => page.evaluate(() => document.getElementById("tiles").toDataURL());
  const looks = [await look()];
  const act = async (action) => {
    await action();
    await settled(page);
    looks.push(await look());
  };
  await act(() => page.check("[name=hue][value=kind]", { force: true }));
  await act(() => page.check("[name=hue][value=level]", { force: true }));
  await act(() => page.check("#show-relaxed"));
  await act(() => page.fill("#depth", "1"));
  await act(() => page.fill("#depth", "0"));
  await act(() => page.uncheck("#show-tiles"));
  assert.equal(new Set(looks).size, looks.length);
  await page.close();
});
