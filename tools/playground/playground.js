// SPDX-License-Identifier: BSD-3-Clause
// The playground: the model file on the left, the page of `se3d live` on the right, the library in a worker between
// them. Nothing is sent anywhere: links keep the text behind the #, which browsers do not send.
"use strict";
(() => {
  const $ = (id) => document.getElementById(id);
  const files = JSON.parse($("files").textContent), first = "pendulum.yaml";
  const live = new TextDecoder().decode(Uint8Array.from(atob($("live").textContent), (c) => c.charCodeAt(0)));
  const source = URL.createObjectURL(new Blob([$("engine").textContent], { type: "text/javascript" }));
  const PATIENCE = 4000, REST = 350; // ms: until a long reading may be ended; after the last key

  let worker = null, scene = "", state = "", sequence = 0, asking = [], pending = 0, watchdog = 0, good = files[first];
  let sent = [], taken = null; // texts that the worker has not taken yet, and the last one that it has
  const answer = (text) => ({ ok: true, status: 200, json: async () => JSON.parse(text) });
  const show = (text) => {
    // a line of a message leads to its place in the text
    $("trouble").replaceChildren(...text.split("\n").flatMap((line, k) => {
      const found = /^model\.yaml:(\d+):(\d+): /.exec(line), parts = k ? ["\n"] : [];
      if (!found) return [...parts, line];
      const link = document.createElement("a");
      link.textContent = found[0].slice(11, -2);
      link.onclick = () => go(Number(found[1]), Number(found[2]));
      return [...parts, link, ": " + line.slice(found[0].length)];
    }));
  };
  const go = (line, column) => {
    const before = $("text").value.split("\n").slice(0, line - 1).reduce((n, l) => n + l.length + 1, 0);
    $("text").focus();
    $("text").setSelectionRange(before + column - 1, before + column);
    $("text").scrollTop = Math.max(0, (line - 4) * parseFloat(getComputedStyle($("text")).lineHeight));
  };
  // What live.js asks of a server.
  window.se3dAsk = (path, how) => {
    if (path === "do") { tell("say", how.body); return Promise.resolve({ ok: true, status: 204 }); }
    if (path === "scene") return Promise.resolve(answer(scene));
    const after = Number(path.slice(path.indexOf("=") + 1));
    if (state && sequence > after) return Promise.resolve(answer(state));
    return new Promise((done) => asking.push(done));
  };
  const tell = (what, words) => {
    worker.postMessage([what, words]);
    if (what !== "save") return;
    sent.push(words);
    ++pending;
    clearTimeout(watchdog);
    watchdog = setTimeout(() => { if (pending) { $("end").hidden = false; $("word").textContent = "it takes long"; } }, PATIENCE);
  };
  const isDone = () => { pending = 0; $("end").hidden = true; $("word").textContent = ""; };
  const hear = ({ data }) => {
    if (data.done === "save") { taken = sent.shift(); isDone(); }
    if (data.scene) scene = data.scene;
    if (data.state) {
      state = data.state;
      const now = JSON.parse(state);
      sequence = now.sequence;
      show(now.trouble.replaceAll("/models/", ""));
      if (!now.trouble && taken !== null) good = taken; // not what is being typed
      for (const done of asking.splice(0)) done(answer(state));
    }
    if (data.trouble) show(data.trouble);
    if (data.fault) { show(`the engine has stopped (${data.fault}); the last model that was right is shown`); begin(good); }
    window.se3dPlay = { sequence, trouble: $("trouble").textContent };
  };
  // A new worker with a text; the page starts anew with it.
  const begin = (text) => {
    if (worker) worker.terminate();
    scene = state = "";
    sequence = 0;
    asking = [];
    sent = [];
    taken = null;
    isDone();
    worker = new Worker(source);
    worker.onmessage = hear;
    worker.onerror = (e) => show(`the engine does not start: ${e.message}`);
    tell("save", text);
    $("page").srcdoc = live;
  };

  let timer = 0;
  $("text").oninput = () => {
    clearTimeout(timer);
    timer = setTimeout(() => tell("save", $("text").value), REST);
  };
  $("text").onkeydown = (e) => {
    if (e.key === "Tab" && !e.shiftKey && !e.ctrlKey && !e.altKey) { // Escape, then Tab, leaves the text
      e.preventDefault();
      document.execCommand("insertText", false, "  ");
    } else if (e.key === "Escape") $("models").focus();
  };
  $("end").onclick = () => begin(good);
  $("models").append(...Object.keys(files).filter((name) => !name.includes("/")).map((name) => new Option(name.replace(/\.yaml$/, ""), name)));
  $("models").onchange = () => { // anew, with the camera that fits
    location.hash = "";
    $("text").value = files[$("models").value];
    begin($("text").value);
  };
  const pack = async (text, stream) => new Uint8Array(await new Response(new Blob([text]).stream().pipeThrough(stream)).arrayBuffer());
  $("link").onclick = async () => {
    const bytes = await pack($("text").value, new CompressionStream("deflate-raw"));
    location.hash = "m=" + btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
    try { await navigator.clipboard.writeText(location.href); $("word").textContent = "copied"; } catch (e) { $("word").textContent = "in the address"; }
  };
  $("download").onclick = () => {
    const a = document.createElement("a");
    a.href = URL.createObjectURL(new Blob([$("text").value], { type: "application/yaml" }));
    a.download = $("models").value || "model.yaml";
    a.click();
    setTimeout(() => URL.revokeObjectURL(a.href), 1000);
  };
  const fromAddress = async () => {
    const given = new URLSearchParams(location.hash.slice(1));
    if (given.has("m")) {
      const bytes = Uint8Array.from(atob(given.get("m").replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
      return new TextDecoder().decode(await pack(bytes, new DecompressionStream("deflate-raw")));
    }
    return files[given.get("model")] || files[first];
  };
  document.addEventListener("visibilitychange", () => tell("watch", !document.hidden));
  fromAddress().catch(() => files[first]).then((text) => {
    $("text").value = text;
    $("models").value = Object.keys(files).find((name) => files[name] === text) || "";
    begin(text);
  });
})();
