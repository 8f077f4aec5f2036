// Opens pages of results in a browser and looks at their pixels: on the width of a phone and of a
// desktop, light and dark. Needs Node, Chromium and two packages; see README.md in this folder.
//
//   node check.mjs [--shots FOLDER] report.html [more.html ...]

import { mkdirSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { PNG } from "pngjs";

const BROWSER = process.env.CHROMIUM || "/usr/bin/chromium";
const FLAGS = [
  "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync",
];
const WIDTHS = [{ name: "phone", width: 400, height: 800 }, { name: "desktop", width: 1280, height: 900 }];

const words = process.argv.slice(2);
const shots = words[0] === "--shots" ? words.splice(0, 2)[1] : null;
if (words.length === 0) {
  console.error("name one page or more");
  process.exit(2);
}
if (shots) mkdirSync(shots, { recursive: true });

let failed = 0;
function expect(what, is_met) {
  if (!is_met) failed += 1;
  console.log(`${is_met ? "ok    " : "FAILED"} ${what}`);
}

const browser = await chromium.launch({ executablePath: BROWSER, args: FLAGS });
for (const file of words) {
  for (const { name, width, height } of WIDTHS) {
    for (const colorScheme of ["light", "dark"]) await look(file, `${name}, ${colorScheme}`, { width, height }, colorScheme);
  }
}
await browser.close();
console.log(failed === 0 ? "all checks passed" : `${failed} checks failed`);
process.exit(failed === 0 ? 0 : 1);

async function look(file, name, viewport, colorScheme) {
  const title = `${basename(dirname(resolve(file)))}/${basename(file)}, ${name}`;
  const page = await browser.newPage({ viewport, colorScheme });
  const complaints = [], requests = [];
  page.on("console", message => { if (message.type() === "error") complaints.push(message.text()); });
  page.on("pageerror", error => complaints.push(String(error)));
  page.on("request", request => requests.push(request.url()));
  await page.goto(pathToFileURL(resolve(file)).href);
  const has_view = await page.locator("#view").count() > 0;
  if (has_view) {
    await page.waitForFunction(() => document.getElementById("view").dataset.state !== "loading", null, { timeout: 60000 });
    await look_at_view(page, title);
  }
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  expect(`${title}: nothing beyond the width of the window (${wide} px)`, wide <= 0);
  expect(`${title}: no complaint ${complaints.join("; ")}`, complaints.length === 0);
  expect(`${title}: nothing from a network`, requests.every(url => /^(file|data|blob):/.test(url)));
  if (shots) await page.screenshot({ path: join(shots, title.replace(/[^a-z0-9.]+/gi, "-") + ".png"), fullPage: true });
  await page.close();
}

async function look_at_view(page, title) {
  expect(`${title}: the view is drawn`, await page.getAttribute("#view", "data-state") === "ready");
  const slider = page.locator("#view .slider");
  const last = +(await slider.getAttribute("max"));
  const set = async frame => {
    await slider.evaluate((element, value) => { element.value = value; element.dispatchEvent(new Event("input")); }, frame);
    await page.waitForFunction(value => document.getElementById("view").dataset.frame == value, frame);
    return pixels(page);
  };
  const first = await set(0), end = await set(last);
  if (last > 0) expect(`${title}: last frame differs from the first`, different(first, end) > 0.0005);
  const middle = await set(Math.round(0.6 * last));
  const ground = await page.evaluate(() =>
    parseInt(getComputedStyle(document.getElementById("view")).getPropertyValue("--view-ground").trim().slice(1), 16));
  expect(`${title}: spheres cover ${percent(covered(middle, ground))} of the view`, covered(middle, ground) > 0.003);
  expect(`${title}: shading gives ${shades(middle)} colours`, shades(middle) > 100);
  await check_colours(page, title, middle);
  await check_hand(page, title, middle, ground);
  await check_cut(page, title, ground);
}

async function check_colours(page, title, before) {
  const modes = await page.locator("#view .mode option").evaluateAll(all => all.map(one => one.value));
  for (const mode of modes.slice(1)) {
    await page.selectOption("#view .mode", mode);
    expect(`${title}: colour by ${mode} changes the view`, different(before, await pixels(page)) > 0.001);
  }
  await page.selectOption("#view .mode", modes[0]);
  expect(`${title}: the first colours come back`, different(before, await pixels(page)) === 0);
}

async function check_hand(page, title, before, ground) {
  const box = await page.locator("#view .canvas").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 90, y + 30, { steps: 4 });
  await page.mouse.up();
  const turned = await pixels(page);
  expect(`${title}: dragging turns it`, different(before, turned) > 0.002);
  await page.mouse.wheel(0, -600);
  await page.waitForTimeout(100);
  const zoomed = await pixels(page);
  expect(`${title}: the wheel zooms in`, covered(zoomed, ground) > covered(turned, ground));
  await page.click("#view .reset");
  expect(`${title}: reset shows the first view`, different(before, await pixels(page)) === 0);
}

async function check_cut(page, title, ground) {
  const walls = page.locator("#view .walls");
  if (await walls.isChecked()) await walls.uncheck();
  const whole = covered(await pixels(page), ground);
  await page.selectOption("#view .axis", "x");
  const covers = [];
  for (const place of [1, 0.5, 0]) {
    await page.locator("#view .cut").evaluate((element, value) => { element.value = value; element.dispatchEvent(new Event("input")); }, place);
    covers.push(covered(await pixels(page), ground));
  }
  expect(`${title}: cutting along x leaves ${covers.map(percent).join(", ")} of ${percent(whole)}`,
    covers[0] >= 0.99 * whole && covers[1] <= covers[0] && covers[2] < covers[0]);
  await page.selectOption("#view .axis", "");
  await walls.check();
}

async function pixels(page) {
  // Two frames, so that what was asked for has been drawn.
  await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
  const { width, height, data } = PNG.sync.read(await page.locator("#view .canvas").screenshot());
  return { width, height, data };
}

function count(image, is_so) {
  let found = 0;
  for (let i = 0; i < image.width * image.height; i++) if (is_so(image.data.readUIntBE(4 * i, 3), i)) found += 1;
  return found / (image.width * image.height);
}
function covered(image, ground) { return count(image, colour => colour !== ground); }
function different(a, b) { return count(a, (colour, i) => colour !== b.data.readUIntBE(4 * i, 3)); }
function shades(image) {
  const found = new Set();
  for (let i = 0; i < image.width * image.height; i++) found.add(image.data.readUIntBE(4 * i, 3));
  return found.size;
}
function percent(part) { return `${(100 * part).toFixed(1)} %`; }
