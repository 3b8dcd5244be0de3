"use strict";
// Magnification, cursor, tables to copy, CSV to save. The page is complete without it.
(() => {
  const points = (line) => Array.from(line.getAttribute("d").matchAll(/([ML])(-?[\d.]+),(-?[\d.]+)/g), (m) => [m[1], +m[2], +m[3]]);
  const number = (value) => (value >= 0 ? "+" : "−") + Math.abs(value).toFixed(1);

  // Polar plots: radius = nominal + deviation (µm) x per_um; angle counter-clockwise from the right.
  const polars = Array.from(document.querySelectorAll("svg.polar"), (svg) => ({
    svg, nominal: +svg.dataset.nominal, perUm: +svg.dataset.perUm,
    lines: Array.from(svg.querySelectorAll("path.measured, path.predicted"), (line) => ({
      line, kind: line.getAttribute("class"),
      at: points(line).map(([pen, x, y]) => [pen, Math.atan2(-y, x), Math.hypot(x, y)]),
    })),
  }));

  function magnify(factor) {
    for (const polar of polars) {
      const { svg, nominal } = polar;
      for (const { line, at } of polar.lines) {
        line.setAttribute("d", at.map(([pen, angle, radius]) => {
          const drawn = Math.max(nominal + factor * (radius - nominal), 0);
          return `${pen}${(drawn * Math.cos(angle)).toFixed(2)},${(-drawn * Math.sin(angle)).toFixed(2)}`;
        }).join(" "));
      }
      for (const ring of svg.querySelectorAll("[data-step]")) {
        const radius = nominal + factor * ring.dataset.step * svg.dataset.division * polar.perUm;
        ring.setAttribute("r", Math.max(radius, 0));
      }
      say(svg, factor);
    }
  }
  function say(svg, factor) {
    const times = +(svg.dataset.magnification * factor).toPrecision(6);
    svg.closest("figure").querySelector(".scale").textContent = `1 ring = ${svg.dataset.division} µm, magnified ${times} times.`;
  }
  document.getElementById("magnify").addEventListener("change", (event) => magnify(+event.target.value));

  for (const box of document.querySelectorAll("[data-series]")) {
    box.addEventListener("change", () => document.body.classList.toggle(`hide-${box.dataset.series}`, !box.checked));
  }

  // The cursor: one angle in both charts of a circle, the values there in words.
  const turn = 2 * Math.PI, apart = (a, b) => Math.abs(((a - b + 3 * Math.PI) % turn) - Math.PI);
  for (const polar of polars) {
    const article = polar.svg.closest("article"), slider = article.querySelector(".cursor input");
    const said = article.querySelector(".cursor output"), flat = article.querySelector("svg.unrolled");
    const hands = [polar.svg, flat].map((svg) => {
      const hand = document.createElementNS("http://www.w3.org/2000/svg", "line");
      hand.setAttribute("class", "hand");
      hand.setAttribute("visibility", "hidden");
      return svg.appendChild(hand);
    });
    const means = Array.from(flat.querySelectorAll("path.mean"), (line) => ({ kind: line.getAttribute("class"), at: points(line) }));
    const low = +flat.dataset.low, high = +flat.dataset.high, box = flat.viewBox.baseVal;
    const across = (degrees) => 42 + (degrees / 360) * (box.width - 50);
    const show = (degrees) => {
      const angle = (degrees * Math.PI) / 180, parts = [];
      for (const side of ["ccw", "cw"]) {
        const values = [];
        for (const { kind, at } of polar.lines.filter((each) => each.kind.endsWith(` ${side}`))) {
          const near = at.reduce((best, each) => (apart(each[1], angle) < apart(best[1], angle) ? each : best));
          values.push(`${kind.split(" ")[0]} ${number((near[2] - polar.nominal) / polar.perUm)}`);
        }
        for (const { at } of means.filter((each) => each.kind.endsWith(` ${side}`))) {
          const near = at.reduce((best, each) => (Math.abs(each[1] - across(degrees)) < Math.abs(best[1] - across(degrees)) ? each : best));
          values.push(`residual ${number(low + ((box.height - 30 - near[2]) / (box.height - 60)) * (high - low))}`);
        }
        if (values.length) parts.push(`${side}: ${values.join(", ")}`);
      }
      said.textContent = `${degrees}° — ${parts.join("; ")} µm`;
      const [round, straight] = hands;
      Object.entries({ x1: 0, y1: 0, x2: 156 * Math.cos(angle), y2: -156 * Math.sin(angle), visibility: "visible" })
        .forEach(([key, value]) => round.setAttribute(key, value));
      Object.entries({ x1: across(degrees), x2: across(degrees), y1: 30, y2: box.height - 30, visibility: "visible" })
        .forEach(([key, value]) => straight.setAttribute(key, value));
      slider.value = degrees;
    };
    slider.addEventListener("input", () => show(+slider.value));
    const follow = (svg, toDegrees) => svg.addEventListener("pointermove", (event) => {
      const place = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
      show(Math.round(((toDegrees(place) % 360) + 360) % 360) % 360);
    });
    follow(polar.svg, (place) => (Math.atan2(-place.y, place.x) * 180) / Math.PI);
    follow(flat, (place) => Math.min(Math.max(((place.x - 42) / (box.width - 50)) * 360, 0), 359));
  }

  // Tables as tab-separated text, as spreadsheets take them.
  for (const table of document.querySelectorAll("table")) {
    const button = document.createElement("button"), name = table.parentElement.getAttribute("aria-label");
    button.type = "button";
    button.className = "copy";
    button.textContent = "copy";
    button.setAttribute("aria-label", `Copy: ${name}`);
    button.addEventListener("click", async () => {
      const text = Array.from(table.rows, (row) => Array.from(row.cells, (cell) => cell.innerText.replace(/\s+/g, " ").trim()).join("\t")).join("\n");
      try {
        await navigator.clipboard.writeText(text);
        button.textContent = "copied";
      } catch {
        getSelection().selectAllChildren(table);
        button.textContent = "selected: press Ctrl-C";
      }
    });
    table.parentElement.after(button);
  }

  for (const button of document.querySelectorAll("button.save")) {
    button.addEventListener("click", () => {
      const blob = new Blob([document.getElementById(button.dataset.csv).textContent.trim() + "\n"], { type: "text/csv" });
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = button.dataset.name;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    });
  }
})();
