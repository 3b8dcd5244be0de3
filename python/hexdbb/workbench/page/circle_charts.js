// Three linked charts of one circle: polar, unrolled, residual against a variable. A cursor, by mouse or arrow keys,
// marks one angle in all of them. Everything is drawn from what Python sends; nothing is computed but places on screen.
//
// ECharts draws what stays while a value is dragged: axes, grids, measured paths, reversals. What follows the value lies
// on a canvas above it (Overlay): a few thousand points drawn there take a millisecond, in ECharts twenty.
import { echarts } from "nicegui-echart";

const INK = "#1F2933", FAINT = "#D9D9D9", MUTED = "#595959", FITTED = "#767676";
const TEXT = { color: INK, fontSize: 12 };
const NEAR_DEG = 2.0; // readings this near to the cursor are highlighted: a few in each lap
const TURN = 360;
const POLAR_SHARE = 0.78; // of the polar chart's half width: outside stand the angles
const LOOSE = 0.4; // an axis that the curves fill by less than this share is drawn anew

const number = (value, digits = 1) => (value >= 0 ? "+" : "\u2212") + Math.abs(value).toFixed(digits);

// Lines come as base64 of 32-bit floats, x and y in turns: a tenth of the time of nested lists.
const unpacked = (text) => new Float32Array(Uint8Array.from(atob(text), (each) => each.charCodeAt(0)).buffer);
const opened = (directions) => directions.map((each) =>
  Object.fromEntries(Object.entries(each).map(([name, line]) => [name, unpacked(line)])));
const pairs = (line) => Array.from({ length: line.length / 2 }, (_, index) => [line[2 * index], line[2 * index + 1]]);

function at(line, angle) {
  // The value of a line at an angle, by linear interpolation.
  if (!line?.length) return NaN;
  let low = 0, high = line.length / 2 - 1;
  if (angle <= line[0]) return line[1];
  if (angle >= line[2 * high]) return line[2 * high + 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (line[2 * middle] <= angle) low = middle;
    else high = middle;
  }
  const share = (angle - line[2 * low]) / (line[2 * high] - line[2 * low]);
  return line[2 * low + 1] + share * (line[2 * high + 1] - line[2 * low + 1]);
}

function extent(lines) {
  let low = Infinity, high = -Infinity;
  for (const line of lines) {
    for (let index = 1; index < line.length; index += 2) {
      if (line[index] < low) low = line[index];
      if (line[index] > high) high = line[index];
    }
  }
  return [low, high];
}

class Overlay {
  // A canvas above a chart. `place` gives a point's pixels: (x, y, into) fills into[0] and into[1].
  constructor(holder) {
    this.holder = holder;
    this.canvas = holder.appendChild(document.createElement("canvas"));
    this.canvas.className = "wb-overlay";
    this.context = this.canvas.getContext("2d");
  }
  clear() {
    const ratio = window.devicePixelRatio || 1, { clientWidth, clientHeight } = this.holder;
    const width = Math.round(clientWidth * ratio), height = Math.round(clientHeight * ratio);
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.context.clearRect(0, 0, clientWidth, clientHeight);
  }
  line(points, color, width, place) {
    const context = this.context, into = [0, 0];
    context.beginPath();
    for (let index = 0; index < points.length; index += 2) {
      place(points[index], points[index + 1], into);
      if (index) context.lineTo(into[0], into[1]);
      else context.moveTo(into[0], into[1]);
    }
    Object.assign(context, { strokeStyle: color, lineWidth: width, lineJoin: "bevel" });
    context.stroke();
  }
  ring(x, y, radius, color) {
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    Object.assign(this.context, { strokeStyle: color, lineWidth: 1.5 });
    this.context.stroke();
  }
  label(text, x, y) {
    Object.assign(this.context, { font: '11px "Roboto", "Segoe UI", sans-serif', textAlign: "center", textBaseline: "middle" });
    const width = this.context.measureText(text).width + 4;
    this.context.fillStyle = "#FFFFFFCC";
    this.context.fillRect(x - width / 2, y - 7, width, 14);
    this.context.fillStyle = INK;
    this.context.fillText(text, x, y);
  }
}

export default {
  template: `
    <div class="wb-circle">
      <figure class="wb-polar">
        <figcaption class="wb-chart-title"><b>{{ title }}</b><span>{{ scaleLabel }}</span></figcaption>
        <div ref="polar" class="wb-canvas" role="img" :aria-label="'Polar chart of ' + title"></div>
      </figure>
      <figure class="wb-unrolled">
        <figcaption class="wb-chart-title"><b>Unrolled</b><span>measured, predicted; below, what the model misses</span></figcaption>
        <div ref="unrolled" class="wb-canvas" role="slider" tabindex="0" aria-label="Angle of the cursor in degrees"
             aria-valuemin="0" aria-valuemax="359" :aria-valuenow="Math.round(cursor ?? 0)" @keydown="key"></div>
      </figure>
      <figure class="wb-against">
        <figcaption class="wb-chart-title"><b>Residual</b><span>against {{ against }}</span></figcaption>
        <div ref="against" class="wb-canvas" role="img" :aria-label="'Residual against ' + against"></div>
      </figure>
      <p class="wb-legend">
        <span v-for="each in legend"><i :style="{ background: each.measuredColour }"></i>measured,
          <i :style="{ background: each.predictedColour }"></i>predicted {{ each.name }}</span>
        <span v-if="hasFitted"><i style="background: #767676"></i>as fitted</span>
      </p>
      <p class="wb-readout" aria-live="off">{{ readout }}</p>
    </div>`,
  data: () => ({ title: "", scaleLabel: "", against: "", cursor: null, legend: [],
    readout: "Point at a chart, or use the arrow keys in the unrolled one, to read an angle in all of them.", hasFitted: false }),
  async mounted() {
    await new Promise((resolve) => setTimeout(resolve, 0));
    this.charts = {};
    this.over = {};
    for (const name of ["polar", "unrolled", "against"]) {
      this.charts[name] = echarts.init(this.$refs[name], null, { renderer: "canvas" });
      this.over[name] = new Overlay(this.$refs[name]);
    }
    this.fitted = [];
    this.points = [];
    this.observer = new ResizeObserver(() => {
      Object.values(this.charts).forEach((chart) => chart.resize());
      this.drawWhole();
    });
    this.observer.observe(this.$el);
    this.listen();
    this.ready = true;
    this.$emit("ready");
  },
  beforeUnmount() {
    this.observer?.disconnect();
    Object.values(this.charts ?? {}).forEach((chart) => chart.dispose());
  },
  methods: {
    show(measured, predicted, fitted) {
      // A circle with a model: `measured` is null where only the model changed, `fitted` where what is fitted did not.
      if (measured) {
        this.measured = { ...measured, lines: opened(measured.lines) };
        this.title = measured.title;
        this.against = measured.against.label;
        this.legend = measured.directions;
      }
      if (fitted) {
        this.fitted = opened(fitted);
        this.hasFitted = fitted.length > 0;
      }
      const isScaled = JSON.stringify(predicted.scale) !== JSON.stringify(this.predicted?.scale);
      this.predicted = { ...predicted, lines: opened(predicted.lines) };
      this.scaleLabel = predicted.scaleLabel;
      if (measured) this.drawWhole();
      else {
        if (isScaled) this.charts.polar.setOption(this.polarOption());
        this.fitScales(fitted !== null);
      }
      this.drawOver();
      this.drawn = (this.drawn ?? 0) + 1;
      this.$el.dataset.drawn = this.drawn;
      window.dispatchEvent(new Event("hexdbb-shown"));
    },
    settle(points) {
      // What follows when a value that is dragged rests: every reading's residual, and axes that fit.
      this.points = points;
      this.charts.against.setOption(this.againstOption());
      this.fitScales(true);
      this.drawOver();
    },
    drawWhole() {
      if (!this.predicted) return;
      this.charts.polar.setOption(this.polarOption(), true);
      this.spans = this.wantedSpans();
      this.charts.unrolled.setOption(this.unrolledOption(), true);
      this.charts.against.setOption(this.againstOption(), true);
      this.drawOver();
    },
    wantedSpans() {
      const { lines } = this.predicted;
      return [
        extent([...this.measured.lines.map((each) => each.measured), ...lines.map((each) => each.predicted)]),
        extent([...lines.map((each) => each.residual), ...this.fitted.map((each) => each.residual)]),
      ];
    },
    fitScales(exactly) {
      // Draws the axes of the unrolled chart anew where the curves leave them, or fill little of them.
      const wanted = this.wantedSpans(), shown = [0, 1].map((panel) => this.axisExtent(panel));
      const isWrong = ([low, high], [from, to]) => low < from || high > to || high - low < LOOSE * (to - from);
      const isOther = exactly && JSON.stringify(wanted) !== JSON.stringify(this.spans);
      if (!isOther && !wanted.some((each, panel) => isWrong(each, shown[panel]))) return;
      this.spans = wanted;
      this.charts.unrolled.setOption({ series: this.spanSeries() });
    },
    axisExtent(panel) {
      return this.charts.unrolled.getModel().getComponent("yAxis", panel).axis.scale.getExtent();
    },
    spanSeries() {
      // Lines that nobody sees: ECharts finds round limits for them.
      return this.spans.map((span, panel) => ({ id: `span${panel}`, type: "line", xAxisIndex: panel, yAxisIndex: panel, silent: true,
        animation: false, showSymbol: false, lineStyle: { opacity: 0 }, data: [[0, span[0]], [TURN, span[1]]] }));
    },
    polarOption() {
      const { centre, division, count } = this.predicted.scale;
      const line = (id, data, color, width, z) => ({
        id, type: "line", coordinateSystem: "polar", data, showSymbol: false, silent: true, animation: false, z,
        lineStyle: { color, width },
      });
      const ring = (radius) => Array.from({ length: 181 }, (_, index) => [radius, 2 * index]);
      return {
        animation: false,
        polar: { center: ["50%", "50%"], radius: `${100 * POLAR_SHARE}%` },
        angleAxis: {
          min: 0, max: TURN, startAngle: 0, clockwise: false, interval: 45, axisLabel: { ...TEXT, formatter: "{value}°" },
          axisLine: { lineStyle: { color: FAINT } }, splitLine: { show: true, lineStyle: { color: FAINT } },
          axisTick: { show: false },
        },
        radiusAxis: {
          min: centre, max: (count + 0.25) * division, axisLine: { show: false }, axisTick: { show: false }, z: 5,
          axisLabel: { show: false }, splitLine: { show: false },
        },
        series: [
          ...[-1, 1].map((side) => line(`grid${side}`, ring(side * count * division), FAINT, 1, 1)),
          line("nominal", ring(0), MUTED, 1, 1),
          ...this.measured.lines.map((each, index) => line(`measured${index}`, pairs(each.measuredPolar).map(([angle, value]) => [value, angle]),
            this.measured.directions[index].measuredColour, 4 - 1.5 * index, 2)),
          {
            id: "reversals", type: "scatter", coordinateSystem: "polar", silent: true, symbolSize: 1, z: 4,
            data: this.measured.reversals.map(([slider, angle]) => ({
              value: [(count + 0.25) * division, angle], label: { show: true, formatter: String(slider), position: "inside",
                color: INK, fontSize: 11, backgroundColor: "#FFFFFFDD", padding: [1, 3], borderRadius: 3 },
            })),
          },
        ],
      };
    },
    unrolledOption() {
      const marks = {
        markLine: {
          silent: true, symbol: "none", animation: false, lineStyle: { color: MUTED, type: "dotted", width: 1, opacity: 1 },
          label: { color: INK, fontSize: 11, formatter: ({ data }) => data.slider, position: "end" },
          data: this.measured.reversals.map(([slider, angle]) => ({ xAxis: angle, slider: String(slider) })),
        },
      };
      const narrow = this.$refs.unrolled.clientWidth < 420;
      const axis = (panel) => ({
        gridIndex: panel, type: "value", min: 0, max: TURN, interval: narrow ? 90 : 45,
        axisLabel: { ...TEXT, show: panel === 1, formatter: "{value}°" }, axisTick: { show: false },
        axisLine: { onZero: false, lineStyle: { color: MUTED } }, splitLine: { lineStyle: { color: FAINT } },
      });
      const scale = (panel, name) => ({
        gridIndex: panel, type: "value", scale: true, name, nameLocation: "middle", nameGap: 40, nameTextStyle: TEXT,
        axisLabel: TEXT, splitNumber: 4, splitLine: { lineStyle: { color: FAINT } },
      });
      return {
        animation: false,
        grid: [{ left: 58, right: 10, top: 18, height: "40%" }, { left: 58, right: 10, bottom: 26, height: "40%" }],
        xAxis: [axis(0), axis(1)],
        yAxis: [scale(0, "deviation, µm"), scale(1, "residual, µm")],
        series: [
          ...this.measured.lines.map((each, index) => ({
            id: `measured${index}`, type: "line", data: pairs(each.measured), xAxisIndex: 0, yAxisIndex: 0, showSymbol: false,
            silent: true, animation: false, z: 2, lineStyle: { color: this.measured.directions[index].measuredColour, width: 3.5 - 1.2 * index },
          })),
          ...this.spanSeries().map((each) => ({ ...each, ...marks })),
        ],
      };
    },
    againstOption() {
      const unit = this.measured.against.unit;
      return {
        animation: false,
        grid: { left: 58, right: 14, top: 12, bottom: 40 },
        xAxis: { type: "value", scale: true, name: unit ? `in ${unit}` : "", nameLocation: "middle", nameGap: 24, nameTextStyle: TEXT,
          axisLabel: { ...TEXT, hideOverlap: true }, splitLine: { show: false }, axisLine: { onZero: false, lineStyle: { color: MUTED } } },
        yAxis: { type: "value", scale: true, name: "residual, µm", nameLocation: "middle", nameGap: 40, nameTextStyle: TEXT,
          axisLabel: TEXT, splitNumber: 4, splitLine: { lineStyle: { color: FAINT } } },
        series: this.points.map((points, index) => ({
          id: `points${index}`, type: "scatter", large: true, largeThreshold: 500, data: points, symbolSize: 3, animation: false, z: 2,
          itemStyle: { color: this.measured.directions[index]?.predictedColour, opacity: 0.55 }, encode: { x: 0, y: 1 },
        })),
      };
    },
    drawOver() {
      // Everything that follows a value or the cursor, once for each frame of the display.
      this.frame ??= requestAnimationFrame(() => {
        this.frame = null;
        if (!this.predicted) return;
        this.drawOverPolar();
        this.drawOverUnrolled();
        this.drawOverAgainst();
      });
    },
    drawOverPolar() {
      const over = this.over.polar, { centre, division, count } = this.predicted.scale;
      over.clear();
      const width = over.holder.clientWidth, height = over.holder.clientHeight;
      const perUm = (POLAR_SHARE * Math.min(width, height)) / 2 / ((count + 0.25) * division - centre);
      const place = (angle, value, into) => {
        const radius = (value - centre) * perUm, radians = (angle * Math.PI) / 180;
        into[0] = width / 2 + radius * Math.cos(radians);
        into[1] = height / 2 - radius * Math.sin(radians);
      };
      this.predicted.lines.forEach((each, index) => over.line(each.polar, this.measured.directions[index].predictedColour, 1.4, place));
      const into = [0, 0];
      for (const value of [count * division, 0, -count * division]) {
        place(67.5, value, into);
        over.label(value ? `${value > 0 ? "+" : "\u2212"}${Math.abs(value)} µm` : "0", ...into);
      }
      if (this.cursor !== null) over.line([this.cursor, centre, this.cursor, (count + 0.25) * division], INK, 1, place);
    },
    drawOverUnrolled() {
      const over = this.over.unrolled, chart = this.charts.unrolled;
      over.clear();
      [0, 1].forEach((panel) => {
        const [low, high] = this.axisExtent(panel);
        const pixels = (point) => chart.convertToPixel({ xAxisIndex: panel, yAxisIndex: panel }, point);
        const [left, bottom] = pixels([0, low]), [right, top] = pixels([TURN, high]);
        const place = (angle, value, into) => {
          into[0] = left + ((right - left) * angle) / TURN;
          into[1] = bottom + ((top - bottom) * (value - low)) / (high - low);
        };
        if (panel) this.fitted.forEach((each) => over.line(each.residual, FITTED, 1, place));
        this.predicted.lines.forEach((each, index) =>
          over.line(panel ? each.residual : each.predicted, this.measured.directions[index].predictedColour, 1.4, place));
        if (this.cursor !== null) over.line([this.cursor, low, this.cursor, high], INK, 1, place);
      });
    },
    drawOverAgainst() {
      this.over.against.clear();
      if (this.cursor === null) return;
      for (const points of this.points) {
        for (const [variable, residual, angle] of points) {
          if (Math.abs(((angle - this.cursor + 540) % TURN) - 180) < NEAR_DEG) {
            this.over.against.ring(...this.charts.against.convertToPixel({ xAxisIndex: 0, yAxisIndex: 0 }, [variable, residual]), 4, INK);
          }
        }
      }
    },
    listen() {
      const polar = this.charts.polar.getZr(), unrolled = this.charts.unrolled.getZr();
      polar.on("mousemove", ({ offsetX, offsetY }) => {
        const x = offsetX - this.charts.polar.getWidth() / 2, y = this.charts.polar.getHeight() / 2 - offsetY;
        this.point((Math.atan2(y, x) * 180) / Math.PI);
      });
      unrolled.on("mousemove", ({ offsetX }) => {
        if (!this.predicted) return;
        const angle = this.charts.unrolled.convertFromPixel({ xAxisIndex: 0 }, offsetX);
        if (angle >= 0 && angle <= TURN) this.point(angle);
      });
      this.charts.against.on("mouseover", ({ value }) => value?.length > 2 && this.point(value[2]));
    },
    key(event) {
      const steps = { ArrowLeft: -1, ArrowRight: 1, ArrowDown: -1, ArrowUp: 1, PageDown: -10, PageUp: 10, Home: -this.cursor };
      if (!(event.key in steps)) return;
      event.preventDefault();
      this.point((this.cursor ?? 0) + steps[event.key]);
    },
    point(angle) {
      if (!this.predicted) return;
      this.cursor = ((angle % TURN) + TURN) % TURN;
      this.drawOver();
      this.read();
      this.tell();
    },
    tell() {
      const now = performance.now();
      if (now - (this.told ?? 0) < 40) {
        clearTimeout(this.later);
        this.later = setTimeout(() => this.tell(), 45);
        return;
      }
      this.told = now;
      this.$emit("cursor", this.cursor);
    },
    read() {
      const angle = this.cursor, measured = this.measured;
      const reversing = measured.reversals.filter(([, place]) => Math.abs(place - angle) < 3).map(([slider]) => slider);
      this.readout = `${angle.toFixed(0)}°: ` + measured.directions.map(({ name }, index) => {
        const { predicted, residual } = this.predicted.lines[index];
        return `${name} measured ${number(at(measured.lines[index].measured, angle))} µm, predicted ${number(at(predicted, angle))} µm, `
          + `residual ${number(at(residual, angle), 2)} µm`;
      }).join("; ") + (reversing.length ? `; slider ${reversing.join(", ")} reverses here` : "");
    },
  },
};
