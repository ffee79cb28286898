// SPDX-License-Identifier: BSD-3-Clause
// The worker of the playground: runs the model, tells the page the scene and the state, takes its words. In front of it
// stands what emscripten makes of the library (`se3dEngine`), and `se3dFiles`, the models by name.
"use strict";
let engine = null, timer = 0, isOpen = false;
const call = (name, type, words = []) => engine.ccall(name, type, words.map((w) => typeof w), words);
const tell = () => {
  const scene = call("se3d_play_take_scene", "string"), state = call("se3d_play_take_state", "string");
  if (scene || state) postMessage({ scene, state });
};
const turn = () => {
  timer = 0;
  const rest = call("se3d_play_turn", "number");
  tell();
  if (rest >= 0 && !timer) timer = setTimeout(turn, 1000 * rest);
};
const wake = () => {
  clearTimeout(timer);
  timer = setTimeout(turn, 0);
};
const act = {
  // The text of the model is another one: the first that is right opens, others are read as a file that was saved.
  save: (text) => {
    engine.FS.writeFile("/models/model.yaml", text);
    if (isOpen) {
      call("se3d_play_save");
    } else {
      const why = call("se3d_play_open", "string", ["/models/model.yaml"]);
      isOpen = why === "";
      if (why) postMessage({ trouble: why.replaceAll("/models/", "") });
    }
  },
  say: (words) => { if (!call("se3d_play_say", "number", [words])) postMessage({ trouble: "too many orders wait" }); },
  watch: (isWatched) => call("se3d_play_watch", null, [isWatched ? 1 : 0]),
};
const waiting = [];
onmessage = ({ data: [what, words] }) => {
  if (!engine) { waiting.push([what, words]); return; }
  try {
    act[what](words);
    postMessage({ done: what });
    wake();
  } catch (e) {
    postMessage({ fault: String(e) });
  }
};
addEventListener("unhandledrejection", (e) => postMessage({ fault: String(e.reason) }));
se3dEngine({ printErr: () => {}, print: () => {} }).then((made) => {
  engine = made;
  engine.FS.mkdir("/models");
  for (const [name, text] of Object.entries(se3dFiles)) {
    const path = `/models/${name}`;
    engine.FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    engine.FS.writeFile(path, text);
  }
  for (const words of waiting.splice(0)) onmessage({ data: words });
});
