// Pictures of the page, for its README and for whoever changes it: node shots.mjs FOLDER
import { join } from "node:path";
import { browser, opened, redrawn, serve } from "./common.mjs";

const into = process.argv[2] ?? ".";
const server = await serve();
const chromium = await browser();
const sizes = { desk: { width: 1280, height: 860 }, phone: { width: 375, height: 780 } };
for (const colorScheme of ["light", "dark"]) {
  for (const [device, viewport] of Object.entries(sizes)) {
    const scale = device === "phone" ? 2 : 1;
    const context = await chromium.newContext({ colorScheme, viewport, deviceScaleFactor: scale, hasTouch: device === "phone" });
    const page = await opened(context, server.address);
    const shot = (view, fullPage = device === "phone") =>
      page.screenshot({ path: join(into, `${device}-${view}-${colorScheme}.png`), fullPage });
    await shot("draw");
    await redrawn(page, () => page.check("[name=show][value=all]", { force: true }));
    await page.waitForTimeout(300);
    await shot("three");
    await page.click("#tab-tiles");
    await page.waitForTimeout(1500);
    await shot("tiles");
    await context.close();
  }
}
await chromium.close();
server.close();
