// Draws each chart of the page: <div class="chart" data-chart="..."> holds what chart.h describes.
"use strict";

// of what has no colour of its own; told apart with red-green weakness, and in grey (Okabe and Ito 2008)
const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];

for (const place of document.querySelectorAll(".chart")) {
  const chart = JSON.parse(place.dataset.chart);
  const intervals = chart.series.some((s) => s.low.length > 0);

  // one row for each x that any series has; a series without it leaves a hole that lines cross
  const rows = new Map();
  chart.series.forEach((series, k) => {
    series.x.forEach((x, i) => {
      if (!rows.has(x)) rows.set(x, [x, ...chart.series.map(() => null)]);
      const y = series.y[i];
      const cell = (low, high) => (y === null ? [NaN, NaN, NaN] : [low ?? y, y, high ?? y]);
      rows.get(x)[k + 1] = intervals
        ? cell(series.low[i], series.high[i])
        : y === null ? NaN : y;
    });
  });
  const data = [...rows.values()].sort((a, b) => a[0] - b[0]);

  const series = {};
  chart.series.forEach((s, k) => {
    const points = s.drawn === "points";
    const faint = s.drawn === "faint";
    const colour = s.colour || colours[k % colours.length];
    series[s.name] = {
      stepPlot: s.drawn === "steps",
      color: faint ? colour + "40" : colour,
      strokeWidth: points ? 0 : faint ? 1 : 2,
      highlightCircleSize: faint ? 0 : 3,
      drawPoints: points,
      pointSize: 2.5,
    };
  });
  const graph = new Dygraph(place, data, {
    title: chart.title,
    xlabel: chart.x_label,
    ylabel: chart.y_label,
    labels: [chart.x_label, ...chart.series.map((s) => s.name)],
    series,
    customBars: intervals,
    connectSeparatedPoints: true,
    legend: "always",
    legendFormatter(data) {
      const named = data.series.filter((s) => chart.series.some((c) => c.name === s.label && c.drawn !== "faint"));
      return Dygraph.Plugins.Legend.defaultFormatter.call(this, { ...data, series: named });
    },
    labelsDiv: place.nextElementSibling,
    digitsAfterDecimal: 3,
    axisLabelFontSize: 12,
    gridLineColor: "#ddd",
    underlayCallback(canvas, area, g) {
      canvas.save();
      canvas.strokeStyle = canvas.fillStyle = "#777";
      canvas.font = "11px sans-serif";
      for (const mark of chart.marks) {
        const x = g.toDomXCoord(mark.x);
        if (x < area.x || x > area.x + area.w) continue;
        canvas.beginPath();
        canvas.setLineDash([4, 3]);
        canvas.moveTo(x, area.y);
        canvas.lineTo(x, area.y + area.h);
        canvas.stroke();
        canvas.fillText(mark.text, x + 3, area.y + 10);
      }
      canvas.restore();
    },
  });
  graph.ready(() => place.classList.add("drawn"));
  window.addEventListener("beforeprint", () => graph.resize());
}
