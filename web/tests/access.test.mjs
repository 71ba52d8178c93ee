// Whoever uses it, however: the keyboard alone, a screen reader, a phone, the dark.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { readdirSync, readFileSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { DIST, browser, download, opened, redrawn, serve } from "./common.mjs";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

let server, chromium;

before(async () => {
  server = await serve();
  chromium = await browser();
});

after(async () => {
  await chromium?.close();
  server?.close();
});

for (const colorScheme of ["light", "dark"]) {
  for (const [device, viewport] of Object.entries({ desk: [1280, 900], phone: [375, 740] })) {
    test(`no known barrier: ${colorScheme}, ${device}`, async () => {
      const [width, height] = viewport;
      const context = await chromium.newContext({ colorScheme, viewport: { width, height }, bypassCSP: true });
      const page = await opened(context, server.address);
      for (const view of ["draw", "tiles"]) {
        await page.click(`#tab-${view}`);
        await page.waitForTimeout(300);
        await page.evaluate(AXE);
        const { violations } = await page.evaluate(() => window.axe.run());
        assert.deepEqual(violations.map(({ id, nodes }) => [id, nodes.map((node) => node.html)]), []);
        const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
        assert.ok(wide <= 0, `${wide} pixels too wide`);
      }
      await context.close();
    });
  }
}

test("everything can be reached and done with the keyboard", async () => {
  const context = await chromium.newContext();
  const page = await opened(context, server.address);
  const reached = new Set();
  const tabTo = async (id) => {
    for (let i = 0; i < 60; i++) {
      await page.keyboard.press("Tab");
      const here = await page.evaluate(() => document.activeElement.id || document.activeElement.value || document.activeElement.dataset.kind);
      reached.add(here);
      if (here === id) return;
    }
    assert.fail(`Tab does not lead to ${id}; it leads to ${[...reached].join(", ")}`);
  };
  await tabTo("refined");
  await redrawn(page, () => page.keyboard.press("ArrowLeft"));
  assert.ok(await page.isChecked("[value=relaxed]"));
  await tabTo("zoom-in");
  await page.keyboard.press("Enter");
  assert.equal(await page.textContent("#zoom-now"), "150 %");
  await tabTo("dots");
  await redrawn(page, () => page.keyboard.press("PageDown"));
  await tabTo("invert");
  await redrawn(page, () => page.keyboard.press("Space"));
  await tabTo("svg");
  const [file] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
  assert.equal(file.suggestedFilename(), "photographer.svg");
  await page.focus("#tab-draw");
  await page.keyboard.press("ArrowRight");
  assert.ok(await page.isVisible("#view-tiles"));
  assert.ok(await page.isHidden("#view-draw"));
  await tabTo("tiles");
  await context.close();
});

test("what is said is said to a screen reader too", async () => {
  const context = await chromium.newContext();
  const page = await opened(context, server.address);
  assert.match(await page.getAttribute("#panes canvas", "aria-label"), /photographer\.jpg as [\d,]+ dots, refined/);
  assert.match(await page.getAttribute("#dots", "aria-valuetext"), /^\d+ dots$/);
  assert.equal(await page.getAttribute("#status", "role"), "status");
  assert.equal(await page.getAttribute("#trouble", "role"), "alert");
  await download(page, "svg");
  assert.equal(await page.textContent("#status"), "photographer.svg is written.");
  await context.close();
});

test("the whole page is less than a megabyte", () => {
  const bytes = readdirSync(DIST).reduce((sum, name) => sum + statSync(join(DIST, name)).size, 0);
  assert.ok(bytes < 1e6, `${bytes} bytes`);
});
