// SPDX-License-Identifier: BSD-3-Clause
// Plots beside the scene, by uPlot: each shows a quantity with its components. They share cursor, zoom and time.
"use strict";
// `names`, `units` of the columns, the first is the time; `rows()` of them, `at(row, column)`; `seek(t)` is called by a click.
const se3dPlots = (box, { names, units, rows, at, seek }) => {
  const { uPlot } = THREE;
  // Okabe and Ito; lighter where the page is dark.
  const strong = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"], light = ["#4a9fe8", "#f5833c", "#1fc795", "#e08cbb", "#f0b429", "#a5dbf7"];
  const hue = (i) => (document.body.classList.contains("dark") ? light : strong)[i % strong.length];
  const quantities = [];
  names.forEach((name, k) => {
    if (k === 0) return;
    const stem = /\.(x|y|z|e[0-3])$/.test(name) ? name.slice(0, name.lastIndexOf(".")) : name, last = quantities[quantities.length - 1];
    if (last && last.name === stem && stem !== name) last.columns.push(k);
    else quantities.push({ name: stem, columns: [k], unit: units[k] || "" });
  });
  const digits = (v) => (v === null || v === undefined ? "" : Math.abs(v) < 1e-12 ? "0" : String(Number(v.toPrecision(5))));
  const colour = (name) => () => (name === "fg" ? getComputedStyle(document.body).color : getComputedStyle(document.body).getPropertyValue(name));
  const shown = [];
  let zoomed = false, moment = 0, active = null, span = null;

  const column = (k) => Array.from({ length: rows() }, (_, r) => { const v = at(r, k); return Number.isFinite(v) ? v : null; });
  const data = (q) => [column(0), ...q.columns.map(column)];
  // What hardly changes has no width of its own.
  const range = (u, low, high) => {
    if (low === null || !Number.isFinite(low)) return [-1, 1];
    const width = high - low;
    const size = Math.max(Math.abs(low), Math.abs(high));
    if (!(width > 1e-6 * size) || width < 1e-12) return size > 1e-9 ? [low - 0.1 * size, high + 0.1 * size] : [low - 1, high + 1];
    return [low - 0.06 * width, high + 0.06 * width];
  };
  const size = () => ({ width: Math.max(120, box.clientWidth - 10), height: box.clientWidth < 300 ? 100 : 150 });
  // Whether each is but rounding beside the largest: it is left out, as of `se3d plot`.
  const areZero = (columns) => {
    const most = columns.map((k) => { let v = 0; for (let r = 0; r < rows(); ++r) v = Math.max(v, Math.abs(at(r, k)) || 0); return v; });
    return most.map((v) => v < 1e-9 * Math.max(...most));
  };
  const small = { font: "11px sans-serif", stroke: colour("fg"), grid: { stroke: colour("--line"), width: 1 }, ticks: { stroke: colour("--line"), size: 4 } };
  const make = (quantity) => {
    const frame = document.createElement("div"), head = document.createElement("div"), away = document.createElement("button");
    frame.className = "plot"; head.className = "plot-head"; away.textContent = "×"; away.title = "close this plot";
    head.append(quantity.name + (quantity.unit ? ` [${quantity.unit}]` : ""), away);
    frame.append(head);
    box.append(frame);
    const zero = areZero(quantity.columns);
    const series = quantity.columns.map((k, i) => ({
      label: (names[k].slice(quantity.name.length + 1) || "value") + (zero[i] ? ", zero" : ""), show: !zero[i], stroke: () => hue(i), width: 1.6, points: { show: false },
      value: (u, v) => `${digits(v)} ${quantity.unit}`,
    }));
    const u = new uPlot({
      ...size(), cursor: { sync: { key: "se3d", setSeries: false, scales: ["x", null] }, drag: { x: true, y: false, dist: 5 }, points: { size: 6 } },
      legend: { live: true, markers: { width: 2 } }, scales: { x: { time: false }, y: { range } },
      axes: [{ ...small, size: 26, gap: 2 }, { ...small, size: 58, gap: 3, space: 20, values: (_, ticks) => ticks.map(digits) }],
      series: [{ label: "t", value: (_, v) => `${digits(v)} s` }, ...series],
      hooks: { setSelect: [(v) => { zoomed = zoomed || v.select.width > 0; }] },
    }, data(quantity), frame);
    const now = document.createElement("div");
    now.className = "now";
    u.over.append(now);
    let from = null;
    u.over.addEventListener("mousedown", (e) => { from = e.clientX; });
    u.over.addEventListener("click", (e) => { if (from !== null && Math.abs(e.clientX - from) < 4) seek(u.posToVal(e.offsetX, "x")); });
    u.over.addEventListener("dblclick", () => { zoomed = false; });
    const made = { quantity, frame, u, now, zero };
    head.onclick = () => { active = made; };
    away.onclick = (e) => { e.stopPropagation(); remove(made); };
    if (shown.length && zoomed) u.setScale("x", { min: shown[0].u.scales.x.min, max: shown[0].u.scales.x.max });
    return made;
  };
  const remove = (made) => {
    const k = shown.indexOf(made);
    if (k < 0) return;
    shown.splice(k, 1);
    made.u.destroy();
    made.frame.remove();
    if (active === made) active = shown[shown.length - 1] || null;
    box.style.display = shown.length ? "" : "none";
  };
  const find = (name) => quantities.find((q) => q.name === name || q.columns.some((k) => names[k] === name));
  const add = (name) => {
    const quantity = find(name);
    if (!quantity || shown.length >= 6) return;
    box.style.display = "";
    active = make(quantity);
    shown.push(active);
    time(moment);
  };
  // Another quantity in the plot that was touched last.
  const replace = (name) => {
    const old = active;
    if (!find(name)) return;
    add(name);
    if (old && shown.includes(old)) {
      const made = shown.pop();
      shown[shown.indexOf(old)] = made;
      old.frame.replaceWith(made.frame);
      old.u.destroy();
      active = made;
    }
  };
  // The line at the time that is shown; the legend has the values there unless the cursor is somewhere.
  const time = (t) => {
    moment = t;
    shown.forEach(({ u, now }) => {
      const x = u.valToPos(t, "x"), inside = x >= 0 && x <= u.over.clientWidth;
      now.style.display = inside ? "block" : "none";
      if (inside) now.style.transform = `translateX(${x - 0.5}px)`;
      if (u.cursor.left < 0 || u.cursor.left === undefined || u.cursor.idx === null || u.cursor.idx === undefined) {
        const times = u.data[0];
        let low = 0, high = times.length - 1;
        while (high - low > 1) { const mid = (low + high) >> 1; if (times[mid] <= t) low = mid; else high = mid; }
        if (times.length) u.setLegend({ idx: high >= 0 && t - times[low] > times[high] - t ? high : low }, false);
      }
    });
  };
  // Other rows than before: live.
  const refresh = () => {
    const next = `${rows()} ${rows() ? at(0, 0) : 0} ${rows() ? at(rows() - 1, 0) : 0}`;
    if (next === span) return;
    span = next;
    shown.forEach(({ quantity, u, zero }) => {
      u.setData(data(quantity), !zoomed);
      if (zoomed) u.redraw();
      if (zero.includes(true)) areZero(quantity.columns).forEach((is, i) => { // what is more than that now comes back
        if (is || !zero[i]) return;
        zero[i] = false;
        const label = u.root.querySelectorAll(".u-series")[i + 1].querySelector(".u-label");
        label.textContent = label.textContent.replace(", zero", "");
        u.setSeries(i + 1, { show: true });
      });
    });
  };
  // The first quantities that change.
  const varies = ({ columns, name }) => !name.endsWith(".orientation") && columns.some((k) => {
    let low = Infinity, high = -Infinity;
    for (let r = 0; r < rows(); ++r) { const v = at(r, k); low = Math.min(low, v); high = Math.max(high, v); }
    return high - low > 1e-9;
  });
  const suggest = (count) => {
    const moving = quantities.filter(varies), first = moving.slice(0, 1), force = moving.find((q) => /\.(force|effort)$/.test(q.name) && q !== first[0]);
    return [...first, ...(force ? [force] : []), ...moving.slice(1)].filter((q, k, all) => all.indexOf(q) === k).slice(0, count).map((q) => q.name);
  };
  const resize = () => shown.forEach(({ u }) => u.setSize(size()));
  return {
    quantities, add, replace, time, refresh, resize, suggest,
    choose: (list) => { while (shown.length) remove(shown[0]); list.forEach(add); },
    names: () => shown.map((p) => p.quantity.name),
    theme: () => shown.forEach(({ u }) => {
      u.redraw(false);
      Array.from(u.root.querySelectorAll(".u-marker")).slice(1 - u.series.length).forEach((mark, k) => { mark.style.borderColor = hue(k); });
    }),
    close: () => { while (shown.length) remove(shown[0]); },
    // For films: title, picture, and where its line is (parts of its width), none: it is out of it.
    pictures: () => shown.map(({ quantity, u }) => ({ title: quantity.name + (quantity.unit ? ` [${quantity.unit}]` : ""), canvas: u.ctx.canvas, frame: u.bbox,
      line: (u.valToPos(moment, "x", true) - u.bbox.left) / u.bbox.width })),
    // For tests.
    state: () => shown.map(({ quantity, u, now }) => ({ name: quantity.name, unit: quantity.unit, columns: quantity.columns.length, zero: u.series.slice(1).map((v) => !v.show), rows: u.data[0].length, colours: u.series.slice(1).map((_, i) => hue(i)), marks: Array.from(u.root.querySelectorAll(".u-marker"), (e) => getComputedStyle(e).borderTopColor).slice(1 - u.series.length),
      min: u.scales.x.min, max: u.scales.x.max, now: u.posToVal(new DOMMatrix(getComputedStyle(now).transform).e + 0.5, "x"), legend: Array.from(u.root.querySelectorAll(".u-value"), (e) => e.textContent),
      over: (({ x, y, width, height }) => [x, y, width, height])(u.over.getBoundingClientRect()) })),
  };
};
