// SPDX-License-Identifier: BSD-3-Clause
// The page of `se3d live`: asks the program for the state of the model again and again, and tells it what the user wants.
"use strict";
(() => {
  const $ = (id) => document.getElementById(id);
  document.body.classList.add("living");
  $("speed").add(new Option("as fast as it goes", "0"));

  // Who answers: the program, or what holds this page (the playground).
  const ask = window.se3dAsk || ((path, how) => fetch(path, how));
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  // Words to the program, one after the other; of the same kind the last one counts.
  const waiting = new Map();
  let busy = false;
  const post = async (kind, words = "") => {
    waiting.delete(kind);
    waiting.set(kind, `${kind.split(" ")[0]} ${words}`.trim());
    if (busy) return;
    busy = true;
    while (waiting.size) {
      const [first, body] = waiting.entries().next().value;
      waiting.delete(first);
      try {
        const answer = await ask("do", { method: "POST", headers: { "Content-Type": "text/plain" }, body });
        if (answer.status === 503) { // too many words wait: once more, unless there are later ones of the kind
          if (!waiting.has(first)) waiting.set(first, body);
          await pause(100);
        }
      } catch (e) { /* `follow` says it */ }
    }
    busy = false;
  };
  let version = -1, list = -1, viewer = null, sliders = [];
  const graves = []; // what frees the pictures before
  // What names a body is said of a version of the scene, what names a number of one of the list of them.
  const live = { post: (kind, words) => post(kind, kind === "pull" ? `${version} ${words}` : words), pulls: () => $("pull").getAttribute("aria-pressed") === "true" };

  const show = (text) => { $("trouble").textContent = text; $("trouble").style.display = text ? "block" : "none"; };
  const digits = (v) => String(Number(v.toPrecision(6)));
  const units = { "kg.m.s-2": "N", "kg.m2.s-2": "N m", "kg.s-2": "N/m", "kg.s-1": "N s/m", "m.s-1": "m/s", "rad.s-1": "rad/s", "s-1": "1/s" };
  const makeSliders = (entries) => {
    sliders = entries.map(({ name, unit, start }, k) => {
      const label = document.createElement("label"), range = document.createElement("input"), number = document.createElement("input");
      const width = Math.abs(start) || 1;
      range.type = "range"; number.type = "number"; number.step = "any";
      Object.assign(range, { min: start - width, max: start + width, step: "any" });
      range.setAttribute("aria-label", name); number.setAttribute("aria-label", name);
      const tell = (text) => { if (text !== "" && Number.isFinite(Number(text))) post(`set ${k}`, `${list} ${k} ${text}`); };
      range.oninput = () => { number.value = digits(Number(range.value)); tell(range.value); };
      number.onchange = () => tell(number.value);
      label.append(name + (unit && unit !== "1" ? ` [${units[unit] || unit}]` : ""), document.createElement("br"), range, " ", number);
      return { label, range, number };
    });
    $("sliders").replaceChildren(...sliders.map((s) => s.label));
  };
  const showNumbers = (values) => values.forEach((value, k) => {
    const { range, number } = sliders[k];
    if (document.activeElement !== range) {
      if (value < Number(range.min)) range.min = value;
      if (value > Number(range.max)) range.max = value;
      range.value = value;
    }
    if (document.activeElement !== number && document.activeElement !== range) number.value = digits(value);
  });

  const open = async () => {
    await window.se3dReady;
    performance.mark("se3d-told");
    if (viewer) viewer.hold(true);
    const scene = await (await ask("scene")).json();
    performance.mark("se3d-scene");
    if (viewer) viewer.share();
    if (viewer) graves.push(viewer.close());
    viewer = await se3dView({ glb: se3dDecode(scene.glb), results: { ...scene.results, values: [] }, packed: scene.box ? { box: scene.box } : null, modes: null, live });
    performance.mark("se3d-built");
    if (scene.list !== list) makeSliders(scene.sliders); // those that stay are not taken from the user's hand
    list = scene.list;
    version = scene.version;
    live.painted = () => { // the first picture
      live.painted = null;
      performance.mark("se3d-painted");
      window.se3dLive.drawn = Date.now();
      graves.splice(0).forEach((bury) => bury());
    };
  };
  const follow = async () => {
    let sequence = 0;
    for (;;) {
      try {
        const answer = await ask(`state?after=${sequence}`);
        if (!answer.ok) throw new Error(answer.statusText);
        const state = await answer.json();
        sequence = state.sequence;
        if (state.version !== version) await open();
        if (state.version === version) {
          viewer.feed(state);
          if (state.list === list) showNumbers(state.numbers);
          show(state.trouble);
          Object.assign(window.se3dLive, { state, version });
        }
      } catch (e) {
        if (viewer) viewer.hold(false);
        show(`${viewer ? "the program has ended, or does not answer" : "no answer from the program"} (${e.message})`);
        sequence = 0;
        await pause(1000);
      }
    }
  };
  for (const kind of ["step", "reset"]) $(kind).onclick = () => post(kind);
  $("defaults").onclick = () => post("anew");
  $("pull").onclick = () => $("pull").setAttribute("aria-pressed", String(!live.pulls()));
  window.se3dLive = { post, state: null, version };
  follow();
})();
