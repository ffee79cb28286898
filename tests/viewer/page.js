// SPDX-License-Identifier: BSD-3-Clause
// Opens a page of `se3d view` in headless Chromium and checks it: node page.js PAGE CSV BODY [PICTURE]
"use strict";
const fs = require("fs"), os = require("os"), path = require("path"), { spawn } = require("child_process");
const [page, csv, body, picture] = process.argv.slice(2);
const profile = fs.mkdtempSync(path.join(os.tmpdir(), "se3d-"));
const chromium = spawn(process.env.SE3D_CHROMIUM || "chromium", ["--headless", "--no-sandbox", "--disable-gpu",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
  "--enable-unsafe-swiftshader", "--window-size=1280,720", "--hide-scrollbars", "--user-data-dir=" + profile,
  "--remote-debugging-pipe", "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
const waiting = new Map(), problems = [];
let number = 0, rest = "", checks = 0, failures = 0;
chromium.stdio[4].on("data", (chunk) => {
  const parts = (rest + chunk).split("\0");
  rest = parts.pop();
  for (const part of parts) {
    const m = JSON.parse(part);
    if (m.id && waiting.has(m.id)) { waiting.get(m.id)(m.result || m); waiting.delete(m.id); }
    if (m.method === "Runtime.exceptionThrown") problems.push(JSON.stringify(m.params.exceptionDetails).slice(0, 600));
    if (m.method === "Log.entryAdded" && m.params.entry.level === "error") problems.push(m.params.entry.text);
    if (m.method === "Runtime.consoleAPICalled" && m.params.type === "error") problems.push(JSON.stringify(m.params.args));
  }
});
let session;
const call = (method, params = {}) => new Promise((done) => {
  waiting.set(++number, done);
  chromium.stdio[3].write(JSON.stringify({ id: number, method, params, sessionId: session }) + "\0");
});
const evaluate = async (expression) => (await call("Runtime.evaluate", { expression, returnByValue: true, awaitPromise: true })).result.value;
const check = (holds, text) => { ++checks; if (!holds) { ++failures; console.error(`failed: ${text}`); } };
const wait = (ms) => new Promise((done) => setTimeout(done, ms));
const key = (name) => call("Input.dispatchKeyEvent", { type: "keyDown", key: name, text: name.length === 1 ? name : undefined });

(async () => {
  const { targetInfos } = await call("Target.getTargets");
  const attached = await call("Target.attachToTarget", { targetId: targetInfos.find((t) => t.type === "page").targetId, flatten: true });
  session = attached.sessionId;
  for (const domain of ["Page", "Runtime", "Log"]) await call(domain + ".enable");
  await call("Page.navigate", { url: "file://" + path.resolve(page) });
  let ready = false;
  for (let k = 0; k < 100 && !ready; ++k) { await wait(100); ready = await evaluate("!!window.se3d"); }
  check(ready, "the page starts");
  const rows = fs.readFileSync(csv, "utf8").trim().split("\n").map((line) => line.split(","));
  const column = rows[0].indexOf(body + ".position.x");
  for (const part of [0.1, 0.37, 0.73, 1]) {
    const row = rows[Math.max(1, Math.round(part * (rows.length - 1)))];
    await evaluate(`se3d.show(${row[0]})`);
    const r = (await evaluate(`se3d.position(${JSON.stringify(body)})`)) || [];
    const off = Math.max(...[0, 1, 2].map((k) => Math.abs(r[k] - Number(row[column + k]))));
    check(off < 1e-4, `at t = ${row[0]} the body is ${off} away`);
  }
  await evaluate("se3d.show(se3d.start)");
  const first = await evaluate("se3d.picture(se3d.start)");
  check(first !== (await evaluate("se3d.picture((se3d.start + 0.4 * (se3d.end - se3d.start)))")), "the picture moves");
  await evaluate("se3d.show(se3d.start)");
  await key("ArrowRight");
  check((await evaluate("se3d.state.time > se3d.start")) === true, "the arrow key steps");
  for (const [name, state] of [["f", "frames"], ["r", "reactions"], ["t", "traces"], ["d", "dark"], [" ", "playing"]]) {
    const before = await evaluate("se3d.state." + state);
    await key(name);
    check((await evaluate("se3d.state." + state)) === !before, `key ${name} changes ${state}`);
  }
  await wait(500);
  const turn = await evaluate("se3d.orbit.azimuth");
  for (const [type, x] of [["mousePressed", 500], ["mouseMoved", 600], ["mouseReleased", 600]]) {
    await call("Input.dispatchMouseEvent", { type, x, y: 400, button: "left", buttons: 1, clickCount: 1 });
  }
  check(Math.abs((await evaluate("se3d.orbit.azimuth")) - turn) > 0.1, "dragging turns the view");
  await evaluate("se3d.set({dark: false}); se3d.show(se3d.start + 0.3 * (se3d.end - se3d.start))");
  if (picture) {
    const shot = await call("Page.captureScreenshot", { format: "png" });
    fs.writeFileSync(picture, Buffer.from(shot.data, "base64"));
  }
  check(problems.length === 0, "no error on the console: " + problems.join("; "));
})().catch((e) => { console.error(e); ++failures; }).finally(() => {
  chromium.kill();
  chromium.on("exit", () => {
    try { // its children may still write there for a moment
      fs.rmSync(profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 200 });
    } catch (e) {
      console.log(`left behind: ${profile} (${e.code})`);
    }
    console.log(`${checks} checks, ${failures} failed`); process.exit(failures ? 1 : 0);
  });
});
setTimeout(() => { console.error("no answer from Chromium"); chromium.kill(); process.exit(1); }, 120000).unref();
