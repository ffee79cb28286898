// SPDX-License-Identifier: BSD-3-Clause
// Opens a page of `se3d view` in headless Chromium and checks it:
//     node page.js PAGE CSV BODY [PICTURE]        a mechanism, whose results are in CSV
//     node page.js PAGE CSV grains                particles: snapshots in CSV; the time of a picture is reported
//     node page.js PAGE none                      that it loads, and may ask nobody
//     node page.js PAGE joints                    that every joint and spring is seen, also on a telephone's screen
//     node page.js PAGE beads                     that a third of the grains is seen
//     node page.js PAGE modes CSV                 shapes of the modes in CSV, of two bodies on springs
//     node page.js ADDRESS live MODEL             the page of `se3d live MODEL`, where it is; MODEL is changed
//     node page.js PAGE playground                the playground: edits, runs, plots, asks nobody
//     node page.js PAGE shots PREFIX              pictures to look at: PREFIX-light.png, -dark.png, -narrow.png
//     node page.js PAGE#ADDRESS still PICTURE     a picture of 1280 x 720 of what the address shows
//     node page.js PAGE second CSV BODY           two runs: BODY of the other one is where CSV says, as a ghost and beside
// Several of these, with `--` between them, are opened one after the other in one browser. With the word `brief` before
// PAGE without keys and mouse.
"use strict";
const fs = require("fs"), os = require("os"), path = require("path"), { spawn } = require("child_process");
const jobs = process.argv.slice(2).join("\n").split(/(?:^|\n)--(?:\n|$)/).filter((words) => words).map((words) => words.split("\n"));
let page, csv, body, picture, brief;
const profile = fs.mkdtempSync(path.join(os.tmpdir(), "se3d-"));
const chromium = spawn(process.env.SE3D_CHROMIUM || "chromium", ["--headless", "--no-sandbox", "--disable-gpu",
  "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
  "--enable-unsafe-swiftshader", "--window-size=800,450", "--hide-scrollbars", "--user-data-dir=" + profile,
  "--remote-debugging-pipe", "about:blank"],
  { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"], env: { ...process.env, TMPDIR: profile }, detached: true });
const end = () => { try { process.kill(-chromium.pid, "SIGKILL"); } catch (e) { /* it has ended */ } }; // with all it started
const waiting = new Map(), problems = [], asked = [];
let number = 0, rest = "", checks = 0, failures = 0;
chromium.stdio[4].on("data", (chunk) => {
  const parts = (rest + chunk).split("\0");
  rest = parts.pop();
  for (const part of parts) {
    const m = JSON.parse(part);
    if (m.id && waiting.has(m.id)) { waiting.get(m.id)(m.result || m); waiting.delete(m.id); }
    if (m.method === "Runtime.exceptionThrown") problems.push(JSON.stringify(m.params.exceptionDetails).slice(0, 600));
    if (m.method === "Network.requestWillBeSent" && !/^(file|blob|data|about):/.test(m.params.request.url)) asked.push(m.params.request.url);
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

const press = (type, x, y, more = {}) => call("Input.dispatchMouseEvent", { type, x, y, button: "left", buttons: 1, clickCount: 1, ...more });
const click = async (id) => {
  const [x, y] = await evaluate(`(() => { const r = document.getElementById("${id}").getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()`);
  for (const type of ["mousePressed", "mouseReleased"]) await press(type, x, y);
};
const drag = async (from, to, more) => {
  await press("mousePressed", from[0], from[1], more);
  await press("mouseMoved", to[0], to[1], more);
  await press("mouseReleased", to[0], to[1], { ...more, buttons: 0 });
};
const choose = (id, value) => evaluate(`(() => { const s = document.getElementById("${id}"); s.value = "${value}"; s.dispatchEvent(new Event("change")); })()`);
// The colour of a pixel of a canvas, 0 to 255.
const pixel = (id, x, y) => evaluate(`(() => {
  const from = document.getElementById("${id}"), to = document.createElement("canvas"), k = from.width / from.clientWidth;
  to.width = to.height = 1;
  const pen = to.getContext("2d");
  pen.drawImage(from, ${x} * k, ${y} * k, 1, 1, 0, 0, 1, 1);
  return Array.from(pen.getImageData(0, 0, 1, 1).data);
})()`);
const apart = (a, b) => Math.max(...a.map((v, k) => Math.abs(v - b[k])));
const read = (path) => {
  const rows = fs.readFileSync(path, "utf8").trim().split("\n").map((line) => line.split(","));
  return { names: rows[0], rows: rows.slice(1).map((row) => row.map(Number)), texts: rows.slice(1) };
};
const checkMotion = async ({ names, rows }) => {
  const column = names.indexOf(body + ".position.x");
  for (const part of [0, 0.1, 0.37, 0.5, 0.73, 1]) {
    const row = rows[Math.round(part * (rows.length - 1))];
    await evaluate(`se3d.show(${row[0]})`);
    const off = apart(await evaluate(`se3d.position(${JSON.stringify(body)})`), row.slice(column, column + 3));
    check(off < 1e-4, `at t = ${row[0]} the body is ${off} away`);
    const length = names.indexOf("spring.length");
    if (length > 0) {
      check(Math.abs((await evaluate('se3d.scale("spring")'))[2] - row[length]) < 1e-4, "the spring stretches");
      const [least, most] = await evaluate('se3d.wire("spring")');
      check(least > 0 && most < 1.001 * least, `its wire is round: ${least} to ${most} m`);
    }
    // The line of the plot is at the time.
    const { now, min, max } = (await evaluate("se3d.plots.state()"))[0];
    check(Math.abs(now - row[0]) < 0.01 * (max - min), `the plot shows t = ${row[0]}: ${now}`);
  }
  const first = await evaluate("se3d.picture(se3d.start)");
  check(first !== (await evaluate("se3d.picture((se3d.start + 0.4 * (se3d.end - se3d.start)))")), "the picture moves");
};
const checkKeys = async () => {
  const time = () => evaluate("(se3d.state.time - se3d.start) / (se3d.end - se3d.start)");
  await key("Home");
  check((await time()) === 0, "Home goes to the start");
  await key("ArrowRight"); await key("ArrowRight");
  check(Math.abs((await time()) - 0.02) < 1e-9, "the right arrow steps");
  await key("ArrowLeft");
  check(Math.abs((await time()) - 0.01) < 1e-9, "the left arrow steps back");
  await key("End");
  check((await time()) === 1, "End goes to the end");
  await key("+");
  check((await evaluate("se3d.state.speed")) === 2 && (await evaluate('document.getElementById("speed").value')) === "2", "+ doubles the speed");
  await key("-"); await key("-");
  check((await evaluate("se3d.state.speed")) === 0.5, "- halves it");
  await evaluate("se3d.set({speed: 1})");
  await key("b");
  check((await evaluate("se3d.state.follow")) === 1, "b follows a body");
  await evaluate("se3d.show(se3d.start + 0.6 * (se3d.end - se3d.start))");
  check((await evaluate("Math.hypot(...['x', 'y', 'z'].map((c, k) => se3d.orbit.target[c] - se3d.position(document.getElementById('follow').selectedOptions[0].text)[k]))")) < 1e-9, "the view follows it");
  await choose("follow", "-1");
  check((await evaluate("se3d.state.follow")) === -1, "nothing is followed any more");
  for (const [name, state] of [["f", "frames"], ["r", "reactions"], ["t", "traces"], ["d", "dark"], [" ", "playing"]]) {
    const picture = "se3d.picture(se3d.start + 0.3 * (se3d.end - se3d.start))";
    const before = await evaluate("se3d.state." + state), seen = await evaluate(picture);
    await evaluate(`se3d.set({${state}: ${before}})`);
    await key(name);
    check((await evaluate("se3d.state." + state)) === !before, `key ${name} changes ${state}`);
    if (state !== "playing" && !(state === "reactions" && (await evaluate("document.getElementById('reactions').disabled")))) {
      await wait(60);
      check(seen !== (await evaluate(picture)), `${state} are seen`);
    }
  }
  await wait(300);
  const now = await time();
  await wait(300);
  check((await evaluate("se3d.state.playing")) && (await time()) !== now, "it plays");
  check((await evaluate("document.body.className")) === "dark", "dark is dark");
  for (const [name, state, value] of [["x", "solid", true], ["x", "solid", false], ["l", "labels", true], ["l", "labels", false], ["c", "cut", 1], ["h", "help", true], ["?", "help", false]]) {
    await key(name);
    check((await evaluate("se3d.state." + state)) === value, `key ${name} makes ${state} ${value}`);
  }
  await evaluate("se3d.set({cut: 0})");
  await evaluate("se3d.set({playing: false, frames: false, traces: false, dark: false})");
};
// A click names what is there; a link brings the view back.
const checkPicks = async () => {
  await key("0");
  await evaluate(`se3d.show(se3d.start + 0.3 * (se3d.end - se3d.start)); se3d.orbit.target.fromArray(se3d.position(${JSON.stringify(body)}))`); // away from what lies over the picture
  await evaluate("se3d.show(se3d.start + 0.3 * (se3d.end - se3d.start))");
  const [x, y] = await evaluate(`se3d.project(se3d.position(${JSON.stringify(body)}))`);
  await press("mousePressed", x, y);
  await press("mouseReleased", x, y, { buttons: 0 });
  await wait(200);
  const text = await evaluate('document.getElementById("info").textContent');
  check((await evaluate("!!se3d.state.picked")) && text.length > 5, `a click says what is there: ${text}`);
  await evaluate("se3d.set({colour: 'speed', labels: true}); se3d.orbit.azimuth = 1.25");
  const link = await evaluate("se3d.share()");
  check(["t=", "view=1.25", "colour=speed", "show=", "picked="].every((word) => link.includes(word)), `the link has all: ${link}`);
  const picked = await evaluate("JSON.stringify(se3d.state.picked)");
  await call("Page.navigate", { url: "about:blank" });
  await call("Page.navigate", { url: link });
  await start();
  const now = await evaluate("({ azimuth: se3d.orbit.azimuth, part: (se3d.state.time - se3d.start) / (se3d.end - se3d.start), picked: JSON.stringify(se3d.state.picked), ...se3d.state })");
  check(Math.abs(now.azimuth - 1.25) < 1e-5 && Math.abs(now.part - 0.3) < 1e-5 && now.colour === "speed" && now.labels && now.picked, `the link brings it back: ${JSON.stringify(now)}`);
  check(picked === (await evaluate("JSON.stringify(se3d.state.picked)")), "and what was picked");
  await evaluate("se3d.set({colour: '', labels: false, picked: null})");
};
// As WCAG 2 says.
const luminance = (c) => [0.2126, 0.7152, 0.0722].reduce((sum, part, k) => sum + part * (c[k] / 255 <= 0.04045 ? c[k] / 255 / 12.92 : ((c[k] / 255 + 0.055) / 1.055) ** 2.4), 0);
const contrast = (a, b) => { const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y); return (high + 0.05) / (low + 0.05); };
const checkJoints = async () => {
  // Where things meet it is darker, and below what is close to the floor.
  await evaluate("se3d.show(se3d.start)");
  const [darkest, lightest] = await evaluate("se3d.light.found()"), mark = await evaluate("se3d.light.mark()");
  check(darkest < 225 && lightest === 255, `ambient occlusion: ${darkest} to ${lightest}`);
  check(mark > 10, `the shadow of contact: ${mark}`);
  // Names do not lie on each other.
  await evaluate("se3d.set({labels: true}); se3d.show(se3d.start)");
  const names = await evaluate(`[...document.querySelectorAll("#labels span")].map((e) => [e.textContent, ...(({ x, y, width, height }) => [x, y, width, height])(e.getBoundingClientRect())])`);
  const written = names.filter(([, , , width]) => width > 0), meet = ([, a, b, w, h], [, c, d, v, g]) => a < c + v - 0.5 && c < a + w - 0.5 && b < d + g - 0.5 && d < b + h - 0.5;
  check(2 * written.length > names.length, `${written.length} of ${names.length} names are written`);
  written.forEach((a, k) => written.slice(k + 1).forEach((b) => check(!meet(a, b), `the names ${a} and ${b} meet`)));
  await evaluate("se3d.set({labels: false})");
  const plain = await colours(""), loaded = await colours("force");
  check(loaded.hues.includes("force") && loaded.legend.startsWith("force [N] ") && loaded.picture !== plain.picture, `colours by force: ${loaded.legend}`);
  await choose("colour", "");
  for (const [width, height, dark] of brief ? [[480, 720, true]] : [[800, 450, false], [480, 720, true]]) {
    await call("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    await evaluate(`se3d.set({dark: ${dark}})`);
    await wait(300);
    check(!(await evaluate("se3d.clipped()")), `at ${width} x ${height} all is in the picture`);
    const least = Math.round(8 * Math.min(width, height) / 450);
    for (const part of brief ? [0.3] : [0, 0.3, 0.62]) {
      const seen = await evaluate(`se3d.seen(se3d.start + ${part} * (se3d.end - se3d.start))`);
      check(seen.length > 0, "there are joints");
      for (const [name, points] of seen) check(points >= least, `at ${width} x ${height}, ${part} of the motion: ${points} points of ${name}`);
    }
    const wide = await evaluate("document.documentElement.scrollWidth");
    check(wide <= width, `nothing is wider than the screen: ${wide}`);
  }
  // Curves stand out in either theme, and their marks are as they are.
  for (const dark of [true, false]) {
    await evaluate(`se3d.set({dark: ${dark}})`);
    for (const { name, colours, marks } of await evaluate("se3d.plots.state()")) {
      const light = colours.map((c) => [1, 3, 5].map((k) => parseInt(c.slice(k, k + 2), 16)));
      check(light.every((c) => `rgb(${c.join(", ")})` === marks[light.indexOf(c)]), `marks of ${name}: ${marks}`);
      if (dark) check(light.every((c) => contrast(c, [32, 39, 46]) > 4.5), `on dark: ${name} ${colours}`);
    }
  }
  await call("Emulation.setDeviceMetricsOverride", { width: 1280, height: 720, deviceScaleFactor: 1, mobile: false });
  await wait(100);
  const bar = await evaluate("document.getElementById('bar').offsetHeight");
  check(bar < 45, `the bar has one row: ${bar}`);
};
const checkBeads = async () => {
  for (const part of brief ? [0.2] : [0, 0.2, 0.7]) {
    const { there, seen } = await evaluate(`se3d.seenGrains(se3d.start + ${part} * (se3d.end - se3d.start))`);
    console.log(`${seen} of ${there} grains: seen`);
    check(there > 100 && 3 * seen >= there, `${seen} of ${there} grains are seen`);
  }
};
// Arrows point where the CSV says, at the times whose results a page keeps.
const checkReactions = async ({ names, rows }) => {
  const time = await evaluate("se3d.sampled(se3d.start + 0.3 * (se3d.end - se3d.start))");
  const row = rows.reduce((a, b) => Math.abs(b[0] - time) < Math.abs(a[0] - time) ? b : a);
  await evaluate(`se3d.set({reactions: true}); se3d.show(${row[0]})`);
  for (const arrow of await evaluate("se3d.arrows()")) {
    const column = names.indexOf(arrow.joint + ".force.x"), force = row.slice(column, column + 3), size = Math.hypot(...force);
    check(apart(arrow.along, force.map((f) => f / size)) < 0.05, `the reaction of ${arrow.joint} points along its force`);
  }
  const some = await evaluate("se3d.arrows().length");
  check(some > 0 || !names.some((name) => name.endsWith(".force.x") && !name.startsWith("spring")), "there are arrows");
  await evaluate("se3d.set({reactions: false})");
};
const checkMouse = async () => {
  const orbit = () => evaluate("[se3d.orbit.azimuth, se3d.orbit.height, se3d.orbit.distance, ...se3d.orbit.target.toArray()]");
  check(await evaluate("se3d.controls.enableDamping"), "the view comes to rest by and by");
  await evaluate("se3d.controls.enableDamping = false");
  const first = await orbit(), height = await evaluate("document.getElementById('view').clientHeight"), turn = (a) => Math.atan2(Math.sin(a), Math.cos(a));
  await drag([300, 200], [400, 230]);
  await wait(300);
  const turned = await orbit();
  check(Math.abs(turn(turned[0] - first[0] + 2 * Math.PI * 100 / height)) < 0.01 && Math.abs(turned[1] - first[1] - 2 * Math.PI * 30 / height) < 0.01, `dragging turns the view: ${first}, ${turned}`);
  await drag([300, 200], [360, 200], { modifiers: 8 });
  await wait(300);
  const moved = await orbit();
  check(apart(moved.slice(3), turned.slice(3)) > 1e-3 * first[2] && Math.abs(moved[0] - turned[0]) < 1e-6, "shift-drag moves it");
  await call("Input.dispatchMouseEvent", { type: "mouseWheel", x: 300, y: 200, deltaX: 0, deltaY: 200 });
  await wait(300);
  check((await orbit())[2] > 1.05 * moved[2], "the wheel zooms");
  for (const state of ["frames", "traces", "dark"]) {
    const before = await evaluate("se3d.state." + state);
    await click(state);
    check((await evaluate("se3d.state." + state)) === !before, `the button ${state} works`);
    await click(state);
  }
  await click("play");
  check((await evaluate("se3d.state.playing")) === true, "the button plays");
  await click("play");
  await evaluate("se3d.show(se3d.start)"); // a press on the thumb would leave it where it is
  await click("time"); // in its middle
  const middle = await evaluate("(se3d.state.time - se3d.start) / (se3d.end - se3d.start)");
  check(Math.abs(middle - 0.5) < 0.02, `the slider scrubs to ${middle} of the run`);
  await choose("speed", "0.25");
  check((await evaluate("se3d.state.speed")) === 0.25, "the speed is chosen");
  await checkPlots();
};
// Several plots share zoom, cursor and time; the legend has the values under the cursor, with units.
const checkPlots = async () => {
  const names = await evaluate("se3d.plots.quantities.map((q) => q.name)"), plots = () => evaluate("se3d.plots.state()");
  if (names.length < 2) return;
  await evaluate(`se3d.plots.choose(${JSON.stringify([names[0]])})`);
  await choose("channel", names[1]);
  check((await plots()).map((p) => p.name).join() === names[1], "another channel is plotted");
  await choose("channel", names[0]);
  await evaluate(`se3d.plots.add(${JSON.stringify(names[1])})`);
  const [one, two] = await plots(), whole = one.max - one.min;
  check(two.name === names[1] && Math.abs(two.max - one.max) < 1e-9 && one.rows > 10 && two.rows === one.rows, "and one more beside it");
  const [left, top, width, high] = one.over, at = (part) => [left + part * width, top + high / 2];
  await drag(at(0.25), at(0.5));
  await until(`se3d.plots.state().every((p) => p.max - p.min < ${0.3 * whole} && p.max - p.min > ${0.2 * whole})`);
  const state = await plots();
  check(Math.abs(state[0].min - state[1].min) < 1e-9, "a zoom is of all plots");
  await call("Input.dispatchMouseEvent", { type: "mouseMoved", x: at(0.7)[0], y: at(0.7)[1] });
  const wanted = state[0].min + 0.7 * (state[0].max - state[0].min), step = whole / (one.rows - 1);
  await until(`se3d.plots.state().every((p) => Math.abs(parseFloat(p.legend[0]) - ${wanted}) < ${2 * step})`);
  const shown = (await plots())[1];
  check(shown.legend.length === shown.columns + 1 && shown.legend[1].endsWith(shown.unit), `values and units: ${shown.legend}`);
  const times = await evaluate("[se3d.start, se3d.end]");
  await evaluate(`document.querySelector(".u-over").dispatchEvent(new MouseEvent("dblclick", { bubbles: true }))`);
  await until(`se3d.plots.state()[0].max - se3d.plots.state()[0].min > ${0.9 * whole}`);
  for (const type of ["mousePressed", "mouseReleased"]) await press(type, ...at(0.5), type === "mouseReleased" ? { buttons: 0 } : {});
  await until(`Math.abs(se3d.state.time - ${(times[0] + times[1]) / 2}) < ${0.05 * (times[1] - times[0])}`);
};
// Where the body is, the picture differs from the same picture's corner of sky.
const checkSeen = async () => {
  await evaluate("se3d.show(se3d.start + 0.3 * (se3d.end - se3d.start))");
  const [x, y] = await evaluate(`se3d.project(se3d.position(${JSON.stringify(body)}))`);
  const there = await pixel("view", x, y), sky = await pixel("view", 5, 60);
  check(apart(there, sky) > 40, `the body is seen at ${x}, ${y}: ${there}, beside ${sky}`);
  const [triangles, same] = await evaluate("se3d.quick(se3d.start)");
  check(triangles < 1 && same > 0.99, `a quick picture is alike: ${triangles} of the triangles, ${same} of the points`);
};
// What can be coloured by, and what the legend and the picture are if it is one of them.
const colours = async (hue) => {
  await choose("colour", hue);
  return evaluate(`({ hues: [...document.getElementById("colour").options].map((o) => o.value), legend: document.getElementById("legend").innerText.replace(/\\s+/g, " "), picture: se3d.picture(se3d.start + 0.7 * (se3d.end - se3d.start)) })`);
};
const checkGrains = async ({ names, rows, texts }) => {
  const ids = rows.map((row) => row[1]), first = ids.reduce((a, b) => Math.min(a, b));
  for (const part of [0, 0.3, 0.61, 1]) {
    const row = rows[Math.round(part * (rows.length - 1))];
    await evaluate(`se3d.show(${row[0]})`);
    const grain = await evaluate(`se3d.grain(${row[1] - first})`);
    check(apart(grain.slice(0, 3), row.slice(3, 6)) < 1e-4 && Math.abs(grain[3] - row[2]) < 1e-6, `at t = ${row[0]} grain ${row[1]} is at ${grain}, not ${row.slice(2, 6)}`);
  }
  const floor = await evaluate("se3d.floor()"), lowest = rows.reduce((a, row) => Math.min(a, row[5] - row[2]), 1e9);
  check(floor < lowest, `grains are above the floor: ${lowest} and ${floor}`);
  // Forces and sets come along in files that tell them.
  const { hues, legend } = await colours("force");
  if (names.includes("force")) check(hues.includes("force") && /^force \[N\] 0\.00.*[1-9]/.test(legend), `colours by force: ${hues}, ${legend}`);
  else check(!hues.includes("force"), "no forces, no colours of them");
  if (names.includes("set")) {
    const column = names.indexOf("set"), sets = [...new Set(texts.map((row) => row[column]))], last = await colours("set");
    check(sets.length < 2 || sets.every((set) => last.legend.includes(set || "without a name")), `sets ${sets}: ${last.legend}`);
    check(sets.length < 2 || last.picture !== (await colours("force")).picture, "sets have colours of their own");
  }
  await choose("colour", "");
  const time = await evaluate("se3d.measure(5, true)"), fine = await evaluate("se3d.measure(3)");
  console.log(`${new Set(ids).size} grains: ${time.toFixed(1)} ms a picture that moves, ${fine.toFixed(1)} ms a fine one, drawn by the processor alone`);
  check(time < 2000, "grains stay interactive");
};
// Bodies a and b move as their shapes say, the spring between them goes along, and all comes back.
const checkModes = async ({ names, rows }) => {
  const place = async (turns, mode) => { if (mode !== undefined) await evaluate(`se3d.mode(${mode}, ${turns})`); return evaluate("['a', 'b'].map((name) => se3d.position(name))"); };
  const still = await place(0, 0), column = (name) => names.indexOf(name);
  for (const [k, row] of rows.entries()) {
    const label = await evaluate(`document.getElementById("mode").options[${k + 1}].text`);
    check(label.startsWith(`${k + 1}: ${row[column("frequency")].toPrecision(4)} Hz`), label);
    for (const turns of [0, 0.2, 0.5, 0.9]) {
      const now = await place(turns, k + 1), moved = now.map((r, i) => r[0] - still[i][0]);
      const wanted = ["a", "b"].map((name) => row[column(name + ".x")] * Math.cos(2 * Math.PI * turns) - row[column(name + ".x_imag")] * Math.sin(2 * Math.PI * turns));
      const much = Math.hypot(...moved) / Math.hypot(...wanted);
      check(apart(moved, wanted.map((v) => v * much)) < 1e-9, `mode ${k + 1} at ${turns}: ${moved}, not as ${wanted}`);
      check(Math.hypot(...moved) > 0.01, `mode ${k + 1} is seen to move: ${moved}`);
      check(Math.abs((await evaluate('se3d.scale("s2")'))[2] - (now[1][0] - now[0][0])) < 1e-6, "the spring goes along");
    }
  }
  check(apart((await place(0, 0)).flat(), still.flat()) < 1e-12, "all comes back");
  await choose("mode", "1");
  const first = await place();
  await until(`se3d.position("a")[0] !== ${first[0][0]}`);
};
const until = async (expression) => {
  for (let k = 0; k < 800; ++k) { const value = await evaluate(expression); if (value) return value; await wait(25); }
  check(false, `${expression} never came`);
};
// A page in which a model runs that has a body, a spring and a parameter `k`.
const checkLive = async (model) => {
  const text = fs.readFileSync(model, "utf8"), place = "se3d.position('block')[0]";
  await until("se3dLive.state && se3dLive.state.t > 0.1");
  const first = await evaluate(place);
  await until(`${place} !== ${first}`);
  check(await evaluate("se3d.state.playing"), "it moves at once");
  await until("se3d.plots.state().length > 0 && se3d.plots.state()[0].rows > 10");
  check((await evaluate("se3d.end - se3d.state.time")) < 0.5, "the plot goes along");
  await key(" ");
  await until("!se3d.state.playing");
  const still = await evaluate("se3d.state.time");
  await key("ArrowRight");
  await until(`se3d.state.time > ${still}`);
  check(Math.abs((await evaluate("se3d.state.time")) - still - 1 / 60) < 1e-6, "the arrow makes a step");
  await key("Home");
  await until("se3d.state.time === 0");
  // A slider: another number in the program.
  const sliders = await evaluate("[...document.querySelectorAll('#sliders label')].map((l) => l.textContent.trim())"), k = sliders.findIndex((s) => s.startsWith("k "));
  check(k >= 0, `sliders: ${sliders}`);
  await evaluate(`(() => { const r = document.querySelectorAll('#sliders input[type=range]')[${k}]; r.value = 80; r.dispatchEvent(new Event('input')); })()`);
  await until(`Math.abs(se3dLive.state.numbers[${k}] - 80) < 1e-3`);
  await click("defaults");
  await until(`se3dLive.state.numbers[${k}] === 50`);
  // Ctrl and the mouse pull; the line to the mouse is seen.
  await key("0");
  const from = await evaluate("se3d.project(se3d.position('block'))"), to = await evaluate("se3d.project([se3d.position('block')[0] + 1, 0, 0])");
  await key(" ");
  await press("mousePressed", from[0], from[1], { modifiers: 2 });
  await press("mouseMoved", to[0], to[1], { modifiers: 2 });
  await until(`${place} > 0.45`);
  await press("mouseReleased", to[0], to[1], { modifiers: 2, buttons: 0 });
  // A saved file is shown; of a wrong one the message, and the old picture.
  const camera = await evaluate("se3d.orbit.azimuth = 0.77");
  const version = await evaluate("se3dLive.version"), begin = Date.now();
  fs.writeFileSync(model, text.replace("[0.3, 0, 0]", "[0.2, 0, 0]").replace(/title: .*/, "title: Saved <b>"));
  const passed = (await until(`document.title === "Saved <b>" && se3dLive.drawn > ${begin} && se3dLive.drawn`)) - begin; // one clock for both
  check((await evaluate("se3dLive.version")) > version, "it is another scene");
  const parts = await evaluate(`performance.getEntriesByType("mark").filter((m) => m.name.startsWith("se3d-") && performance.timeOrigin + m.startTime > ${begin} && performance.timeOrigin + m.startTime < ${begin + passed} + 1).map((m) => m.name.slice(5) + " " + Math.round(performance.timeOrigin + m.startTime - ${begin})).join(", ")`);
  console.log(`${passed.toFixed(0)} ms from saving to the new picture (${parts})`);
  check(passed < 3000, `a saved file is shown soon: ${passed} ms`);
  check(Math.abs((await evaluate("se3d.orbit.azimuth")) - camera) < 1e-5, "the camera stays");
  fs.writeFileSync(model, text.replace("type: prismatic", "type: prismatik"));
  const trouble = await until("document.getElementById('trouble').textContent");
  check(/:7:\d+: .*prismatik/.test(trouble) && (await evaluate("document.title")) === "Saved <b>", `the message: ${trouble}`);
  fs.writeFileSync(model, text);
  await until("!document.getElementById('trouble').textContent && document.title !== 'Saved <b>'");
};
// The text of a model is edited, what it does is seen.
const checkPlayground = async () => {
  const inside = "document.getElementById('page').contentWindow", text = "document.getElementById('text')";
  const write = (words) => evaluate(`(() => { ${text}.value = ${JSON.stringify(words)}; ${text}.dispatchEvent(new Event("input")); })()`);
  const title = `${inside}.document.title`, trouble = "document.getElementById('trouble').textContent";
  await until(`${inside}.se3dLive && ${inside}.se3dLive.state && ${inside}.se3dLive.state.t > 0.05`);
  const model = (stiffness, type) => `se3d: 1\ntitle: spring ${stiffness}\nparameters: {free: 0.1}\ngravity: [0, 0, 0]\nbodies: [{name: block, mass: 1, inertia: [1, 1, 1], position: [0.3, 0, 0]}]\n` +
    `joints: [{name: rail, type: ${type}, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, 0]}]\n` +
    `forces: [{name: spring, type: rsda_or_tsda, body_i: ground, body_j: block, k: ${stiffness}, l0: free}]\n`.replace("rsda_or_", "") +
    "analysis: {type: dynamics, duration: 10}\noutput: [{file: x.csv, channels: [block.position.x], every: 0.01}]\n";
  await write(model(50, "prismatic"));
  await until(`${title} === "spring 50"`);
  await until(`${inside}.se3dLive.state.t > 0.05 && ${inside}.se3d.position("block")[0] < 0.299`);
  check((await evaluate(`${inside}.document.getElementById("channel").options.length`)) > 0, "there is something to plot");
  await until(`${inside}.se3d.state.time > 0.2`);
  await until(`${inside}.se3d.plots.state().length > 0 && ${inside}.se3d.plots.state()[0].rows > 10`);
  await evaluate(`(() => { const r = ${inside}.document.querySelector("#sliders input[type=range]"); r.value = 0.15; r.dispatchEvent(new Event("input")); })()`);
  await until(`Math.abs(${inside}.se3dLive.state.numbers[0] - 0.15) < 1e-3`);
  await write(model(70, "prismatik"));
  await until(`/^6:\\d+: .*prismatik/.test(${trouble})`);
  check((await evaluate(title)) === "spring 50", "a wrong text leaves the old picture");
  await evaluate("document.querySelector('#trouble a').click()");
  check((await evaluate(`${text}.value.slice(0, ${text}.selectionStart).split("\\n").length`)) === 6, "the message leads to the line");
  await write(model(80, "prismatic"));
  await until(`${title} === "spring 80" && ${trouble} === ""`);
  await click("link");
  await until("location.hash.startsWith('#m=')");
  await call("Page.reload");
  await wait(300);
  await until(`${inside} && ${inside}.document.title === "spring 80" && !!${inside}.se3dLive.state`);
  await choose("models", "fourbar.yaml");
  await until(`${title} !== "spring 80" && !!${inside}.se3dLive.state && ${inside}.se3dLive.state.running`);
  check(asked.length === 0, `nothing is asked of a network: ${asked}`);
};
const start = async () => {
  let ready = false;
  const shown = csv === "playground" ? "!!document.getElementById('page').contentWindow.se3d" : "!!window.se3d";
  for (let k = 0; k < 800 && !ready; ++k) { await wait(25); ready = await evaluate(shown); }
  check(ready, "the page starts");
};

// The other run moves as its own results say; beside, it is not where the first one is.
const checkSecond = async ({ names, rows }, name) => {
  const column = names.indexOf(name + ".position.x"), where = () => evaluate(`se3d.second(${JSON.stringify(name)})`), pictures = new Set();
  for (const part of [0.2, 0.7]) {
    const row = rows[Math.round(part * (rows.length - 1))];
    await evaluate(`se3d.show(${row[0]})`);
    check(apart(await where(), row.slice(column, column + 3)) < 1e-4, `the other run at t = ${row[0]}: ${await where()}`);
  }
  const at = await evaluate(`se3d.project(se3d.second(${JSON.stringify(name)}))`);
  check(at[0] > 0 && at[0] < 800 && at[1] > 0 && at[1] < 450, `it is in the picture: ${at}`);
  const [ghost, own] = [await where(), await evaluate(`se3d.position(${JSON.stringify(name)})`)];
  check(apart(ghost, own) > 1e-3, "it is another one");
  for (const state of ["beside", "off", "ghost"]) {
    pictures.add(await evaluate("se3d.picture(se3d.state.time)"));
    await key("g");
    check((await evaluate("se3d.state.second")) === state, `g: ${state}`);
    await evaluate("se3d.show(se3d.state.time)");
    if (state === "beside") check(apart(await where(), ghost) > 0.03 && !(await evaluate("se3d.clipped()")), "it stands beside, in the picture");
  }
  check(pictures.size === 3, "as a ghost, beside and without it are three pictures");
};
const shoot = async (path) => {
  await evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
  const shot = await call("Page.captureScreenshot", { format: "png" });
  fs.writeFileSync(path, Buffer.from(shot.data, "base64"));
};
// What one sees who opens the page: in both themes, and on a telephone.
const takeShots = async (prefix) => {
  for (const [name, width, height, dark] of [["light", 1280, 720, false], ["dark", 1280, 720, true], ["narrow", 480, 800, false]]) {
    await call("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    await evaluate(`se3d.set({dark: ${dark}}); se3d.show(se3d.start + 0.3 * (se3d.end - se3d.start))`);
    check((await evaluate("se3d.state.follow > 0 || !se3d.clipped()")), `${name}: all is in the picture`);
    check((await evaluate("document.documentElement.scrollWidth")) <= width, `${name}: nothing is wider than the screen`);
    await shoot(`${prefix}-${name}.png`);
  }
};
const run = async () => {
  await call("Page.navigate", { url: page.startsWith("http:") ? page : "file://" + path.resolve(page) });
  await start();
  if (csv === "joints") {
    await checkJoints();
  } else if (csv === "shots") {
    await takeShots(body);
    return;
  } else if (csv === "still") {
    await call("Emulation.setDeviceMetricsOverride", { width: 1280, height: 720, deviceScaleFactor: 1, mobile: false });
    await wait(100);
    await evaluate("se3d.show(se3d.state.time)");
    await shoot(body);
    return;
  } else if (csv === "modes") {
    await checkModes(read(body));
  } else if (csv === "live") {
    await checkLive(body);
  } else if (csv === "playground") {
    await checkPlayground();
  } else if (csv === "second") {
    await checkSecond(read(body), picture);
    picture = undefined;
  } else if (csv === "none") {
    const refused = await evaluate(`new Promise((done) => { addEventListener("securitypolicyviolation", (e) => done(e.effectiveDirective));
      fetch("http://127.0.0.1:9/").catch(() => {}); setTimeout(() => done("nothing"), 2000); })`);
    check(refused === "connect-src", `what asks a network is refused: ${refused}`);
    await wait(100);
    problems.splice(0, problems.length, ...problems.filter((text) => !text.includes("127.0.0.1:9")));
    asked.length = 0;
  } else if (csv === "beads") {
    await checkBeads();
  } else if (body === "grains") {
    await checkGrains(read(csv));
  } else if (csv !== "none") {
    const results = read(csv);
    await checkMotion(results);
    await checkSeen();
    await checkReactions(results);
    if (!brief) {
      await checkKeys();
      await checkMouse();
      await checkPicks();
    }
  }
  if (csv !== "live" && csv !== "playground") await evaluate("se3d.set({dark: false}); se3d.show(se3d.start + 0.3 * (se3d.end - se3d.start))");
  if (picture) await shoot(picture);
  check(problems.length === 0, "no error on the console: " + problems.join("; "));
  if (!page.startsWith("http:")) check(asked.length === 0, `nothing is asked of a network: ${asked}`);
};

(async () => {
  const { targetInfos } = await call("Target.getTargets");
  const attached = await call("Target.attachToTarget", { targetId: targetInfos.find((t) => t.type === "page").targetId, flatten: true });
  session = attached.sessionId;
  for (const domain of ["Page", "Runtime", "Log", "Network"]) await call(domain + ".enable");
  for (const words of jobs) {
    brief = words[0] === "brief";
    [page, csv, body, picture] = words.slice(brief ? 1 : 0);
    // A quarter of the points where none are counted or timed, nor shown to anybody: the processor draws them.
    const coarse = !["joints", "beads", "live", "playground", "shots", "still"].includes(csv) && body !== "grains" && !picture;
    const before = failures;
    await call("Page.navigate", { url: "about:blank" });
    await call("Emulation.clearDeviceMetricsOverride");
    if (coarse) await call("Emulation.setDeviceMetricsOverride", { width: 800, height: 450, deviceScaleFactor: 0.5, mobile: false });
    problems.length = 0;
    await run();
    if (failures > before) console.error(`that was ${page} ${csv}`);
  }
})().catch((e) => { console.error(e); ++failures; }).finally(() => {
  chromium.on("exit", async () => {
    end();
    for (let k = 0; k < 100 && fs.existsSync(profile); ++k) { // its children may still write there for a moment
      try { fs.rmSync(profile, { recursive: true, force: true }); } catch (e) { await wait(100); }
    }
    console.log(`${checks} checks, ${failures} failed`); process.exit(failures ? 1 : 0);
  });
  call("Browser.close");
  setTimeout(end, 5000).unref();
});
setTimeout(() => { console.error("no answer from Chromium"); end(); fs.rmSync(profile, { recursive: true, force: true }); process.exit(1); }, 400000).unref();
