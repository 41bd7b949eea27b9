// Saves and copies the figures of the page, and draws the trials that can be looked at.
"use strict";

const kDots = 300;  // of a saved PNG, per inch

function save(content, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

function source(svg) {
  return new Blob([new XMLSerializer().serializeToString(svg)], { type: "image/svg+xml" });
}

async function png(svg) {
  const image = new Image();
  image.src = URL.createObjectURL(source(svg));
  await image.decode();
  const canvas = document.createElement("canvas");
  // an SVG has its size in points, and a browser counts 96 pixels to the inch
  canvas.width = Math.round(svg.width.baseVal.value / 96 * kDots);
  canvas.height = Math.round(svg.height.baseVal.value / 96 * kDots);
  const pen = canvas.getContext("2d");
  pen.fillStyle = "white";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(image, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(image.src);
  return new Promise((done) => canvas.toBlob(done, "image/png"));
}

for (const figure of document.querySelectorAll("figure")) {
  const svg = figure.querySelector("svg");
  const name = figure.dataset.name;
  for (const button of figure.querySelectorAll("button[data-save]")) {
    button.addEventListener("click", async () => {
      const kind = button.dataset.save;
      if (kind === "svg") save(source(svg), name + ".svg");
      if (kind === "csv") save(new Blob([figure.querySelector("template").content.textContent], { type: "text/csv" }), name + ".csv");
      if (kind === "png") save(await png(svg), name + ".png");
      if (kind !== "copy") return;
      const before = button.textContent;
      try {
        await navigator.clipboard.write([new ClipboardItem({ "image/png": png(svg) })]);
        button.textContent = "Copied";
      } catch {
        button.textContent = "The browser does not allow it: save the figure";
      }
      setTimeout(() => { button.textContent = before; }, 3000);
    });
  }
}

// The viewer: one strip for each quantity, over the time of the trial.
for (const viewer of document.querySelectorAll(".viewer")) {
  const data = JSON.parse(viewer.querySelector("script").textContent);
  const [previous, next] = viewer.querySelectorAll("button");
  const choice = viewer.querySelector("select");
  const said = viewer.querySelector("span");
  const strips = viewer.querySelector("div");
  data.trials.forEach((trial, i) => choice.add(new Option(trial.name, i)));

  const decoded = (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Float32Array(bytes.buffer);
  };
  const draw = () => {
    const trial = data.trials[choice.value];
    const ink = getComputedStyle(viewer).color;
    strips.replaceChildren();
    said.textContent = trial.about;
    data.quantities.forEach((quantity, k) => {
      const curves = trial.values[k].map(decoded);
      const all = curves.flatMap((curve) => [...curve].filter(Number.isFinite));
      if (all.length === 0) return;
      const canvas = strips.appendChild(document.createElement("canvas"));
      const dots = window.devicePixelRatio || 1;
      const [width, height] = [canvas.clientWidth, canvas.clientHeight];
      canvas.width = width * dots;
      canvas.height = height * dots;
      const pen = canvas.getContext("2d");
      pen.scale(dots, dots);
      pen.font = "11px sans-serif";
      let [low, high] = [Math.min(...all), Math.max(...all)];
      if (high - low < 1e-9) [low, high] = [low - 0.5, high + 0.5];
      const [left, top, bottom] = [52, 16, 18];
      const x = (t) => left + (width - left - 4) * t / trial.seconds;
      const y = (v) => height - bottom - (height - bottom - top) * (v - low) / (high - low);
      pen.fillStyle = ink;
      pen.fillText(`${quantity.name} [${quantity.unit}]`, left, 11);
      pen.textAlign = "right";
      for (const v of [low, high]) pen.fillText(v.toPrecision(3), left - 4, y(v) + 4);
      pen.textAlign = "left";
      pen.fillText("0", left, height - 4);
      pen.textAlign = "right";
      pen.fillText(`${trial.seconds.toPrecision(3)} s`, width - 2, height - 4);
      pen.strokeStyle = "#888";
      let written = -100;  // where the last name was: names that are closer hide each other
      for (const mark of trial.marks) {
        pen.beginPath();
        pen.setLineDash([3, 3]);
        pen.moveTo(x(mark.t), top);
        pen.lineTo(x(mark.t), height - bottom);
        pen.stroke();
        pen.textAlign = "left";
        pen.fillStyle = "#888";
        if (k !== 0 || x(mark.t) < written) continue;
        pen.fillText(mark.name, Math.min(x(mark.t) + 2, width - 60), top + 9);
        written = x(mark.t) + pen.measureText(mark.name).width + 6;
      }
      pen.setLineDash([]);
      curves.forEach((curve, i) => {
        pen.strokeStyle = quantity.curves[i].colour;
        pen.lineWidth = 1.4;
        pen.beginPath();
        curve.forEach((v, n) => pen.lineTo(x(trial.seconds * n / (curve.length - 1)), y(v)));
        pen.stroke();
        pen.fillStyle = quantity.curves[i].colour;
        pen.textAlign = "right";
        pen.fillText(quantity.curves[i].name, width - 4 - 90 * (curves.length - 1 - i), 11);
      });
    });
  };
  const step = (by) => {
    choice.selectedIndex = Math.min(Math.max(choice.selectedIndex + by, 0), data.trials.length - 1);
    draw();
  };
  previous.addEventListener("click", () => step(-1));
  next.addEventListener("click", () => step(1));
  choice.addEventListener("change", draw);
  window.addEventListener("resize", draw);
  draw();
}
