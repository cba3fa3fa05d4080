// Screenshots of reports' sections: node gallery.mjs MODULES CHROMIUM {PAGE SECTION:WIDTH:SCHEME...}...; writes docs/images/report-SECTION.jpg, and report.json:
// the template of the pages and the checksums of the documents in the repository that they show. docs/report.md then no longer says that they are older.
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const OLDER = /^The screenshots are of an older page\.\n\n/m;
const [modules, executablePath, ...words] = process.argv.slice(2);
const { chromium } = createRequire(`${modules}/node_modules/`)("playwright-core");
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-dev-shm-usage"] });
const made = { template: null, documents: {} };
let address;
for (const word of words) {
  if (word.endsWith(".html")) {
    address = pathToFileURL(word).href;
    continue;
  }
  const [section, width, colorScheme] = word.split(":");
  const page = await browser.newPage({ viewport: { width: Number(width), height: width < 600 ? 844 : 900 }, colorScheme });
  await page.goto(address);
  await page.waitForSelector("html[data-ready]");
  made.template = await page.locator("meta[name=template]").getAttribute("content");
  for (const { name, xxh3 } of await page.evaluate("page.documents")) if (name.endsWith(".md")) made.documents[name] = xxh3;
  // Twice: sections above are drawn when they come into sight, and move the others.
  for (let k = 0; k < 2; k += 1) {
    await page.evaluate((id) => (id === "verdict" ? scrollTo(0, 0) : document.getElementById(id).scrollIntoView()), section);
    await page.waitForTimeout(1500);
  }
  await page.screenshot({ path: `docs/images/report-${section}.jpg`, type: "jpeg", quality: 80 });
  await page.close();
}
await browser.close();
writeFileSync("docs/images/report.json", `${JSON.stringify(made, null, 2)}\n`);
writeFileSync("docs/report.md", readFileSync("docs/report.md", "utf8").replace(OLDER, ""));
