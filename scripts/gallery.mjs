// Screenshots of a report's sections: node gallery.mjs MODULES CHROMIUM PAGE NAME SECTION:WIDTH:SCHEME[:SCENE]...; writes docs/images/report-NAME-SECTION.jpg.
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const [modules, executablePath, file, name, ...shots] = process.argv.slice(2);
const { chromium } = createRequire(`${modules}/node_modules/`)("playwright-core");
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-dev-shm-usage"] });
for (const shot of shots) {
  const [section, width, colorScheme, scene] = shot.split(":");
  const page = await browser.newPage({ viewport: { width: Number(width), height: width < 600 ? 844 : 900 }, colorScheme });
  await page.goto(pathToFileURL(file).href);
  await page.waitForSelector("html[data-ready]");
  if (scene) await page.getByLabel("Scene", { exact: true }).selectOption(scene);
  // Twice: sections above are drawn when they come into sight, and move the others.
  for (let k = 0; k < 2; k += 1) {
    await page.evaluate((id) => (id === "top" ? scrollTo(0, 0) : document.getElementById(id).scrollIntoView()), section);
    await page.waitForTimeout(1500);
  }
  await page.screenshot({ path: `docs/images/report-${name}-${section}.jpg`, type: "jpeg", quality: 80 });
  await page.close();
}
await browser.close();
