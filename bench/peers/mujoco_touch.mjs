// SPDX-License-Identifier: BSD-3-Clause
// The heap of bench/touch.h by MuJoCo 3 as WebAssembly (npm install @mujoco/mujoco):
//
//     node mujoco_touch.mjs N STEP DURATION TIMECONST SOLVER [REPEATS]
//
// with the arguments of mujoco_touch.c. CPU time of the process around the stepping.
import load from '@mujoco/mujoco';

const [n, step, duration, constant] = process.argv.slice(2, 6).map(Number);
const solver = process.argv[6] ?? 'Newton', repeats = Number(process.argv[7] ?? 1);

let seed = 1n;
const random = () => {
  seed = BigInt.asUintN(64, seed * 6364136223846793005n + 1442695040888963407n);
  return Number(seed >> 11n) / 4503599627370496 - 1;
};

function heap() {
  let side = 1, text = '';
  while (side ** 3 < n) side++;
  for (let k = 0; k < n; k++) {
    const place = [k % side, Math.floor(k / side) % side, Math.floor(k / side ** 2)];
    const at = [], turn = [1];
    for (let c = 0; c < 3; c++) {
      at.push(c < 2 ? 0.16 * (place[c] - 0.5 * (side - 1)) + 0.01 * random()
                    : 0.12 + 0.18 * place[c]);
      turn.push(0.3 * random());
    }
    const size = Math.hypot(...turn);
    const quat = turn.map((p) => p / size);
    text += `<body pos="${at.join(' ')}" quat="${quat.join(' ')}"><freejoint/>` +
      '<geom type="box" size=".05 .05 .05"/></body>';
  }
  return text;
}

const mujoco = await load();
const model = mujoco.MjModel.from_xml_string(`<mujoco>
  <option gravity="0 0 -9.81" timestep="${step}" solver="${solver}" cone="elliptic"/>
  <size memory="1G"/>
  <default><geom density="1000" friction=".5 .005 .0001" solref="${constant * step} 1" condim="3"/>
  </default><worldbody><geom type="plane" size="0 0 1"/>${heap()}</worldbody></mujoco>`);
const data = new mujoco.MjData(model);
const steps = Math.ceil(duration / step - 1e-6);
let least = Infinity;
for (let r = 0; r < repeats; r++) {
  mujoco.mj_resetData(model, data);
  const start = process.cpuUsage();
  for (let k = 0; k < steps; k++) mujoco.mj_step(model, data);
  const used = process.cpuUsage(start);
  least = Math.min(least, 1e-6 * (used.user + used.system));
}
let deepest = 0, sum = 0, count = 0;
const contacts = data.contact;
for (let k = 0; k < data.ncon; k++) {
  const overlap = -contacts.get(k).dist;
  deepest = Math.max(deepest, overlap);
  sum += Math.max(overlap, 0);
  count += overlap > 0 ? 1 : 0;
}
console.log(`MuJoCo heap ${n}, step ${step} s, ${solver}: CPU ${least.toPrecision(4)} s, ` +
  `${count} contacts, overlap ${(1e3 * sum / count).toPrecision(3)} mm (deepest ` +
  `${(1e3 * deepest).toPrecision(3)})`);
