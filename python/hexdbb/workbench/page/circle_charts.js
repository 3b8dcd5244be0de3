// Three linked charts of one circle: polar, unrolled, residual against a variable. A cursor, by mouse or arrow keys,
// marks one angle in all of them. Everything is drawn from what Python sends; nothing is computed but places on screen.
import { echarts } from "nicegui-echart";

const INK = "#1F2933", FAINT = "#D9D9D9", MUTED = "#595959", FITTED = "#767676";
const TEXT = { color: INK, fontSize: 12 };
const NEAR_DEG = 2.0; // readings this near to the cursor are highlighted: a few in each lap
const TURN = 360;
const POLAR_MS = 110; // while a value is dragged the polar chart follows nine times a second, the unrolled one always
const REST_MS = 60; // points follow a value that is dragged when it rests this long
const STANDING = /^(measured|nominal|cursor|near)/; // series that do not change with the model

const number = (value, digits = 1) => (value >= 0 ? "+" : "\u2212") + Math.abs(value).toFixed(digits);

function at(line, angle) {
  // The value of a line of [angle, value] at an angle, by linear interpolation.
  if (!line?.length) return NaN;
  let low = 0, high = line.length - 1;
  if (angle <= line[0][0]) return line[0][1];
  if (angle >= line[high][0]) return line[high][1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (line[middle][0] <= angle) low = middle;
    else high = middle;
  }
  const share = (angle - line[low][0]) / (line[high][0] - line[low][0]);
  return line[low][1] + share * (line[high][1] - line[low][1]);
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
    for (const name of ["polar", "unrolled", "against"]) {
      this.charts[name] = echarts.init(this.$refs[name], null, { renderer: "canvas" });
    }
    this.observer = new ResizeObserver(() => {
      Object.values(this.charts).forEach((chart) => chart.resize());
      this.draw(true);
    });
    this.observer.observe(this.$el);
    this.follow();
    this.ready = true;
    this.$emit("ready");
  },
  beforeUnmount() {
    this.observer?.disconnect();
    Object.values(this.charts ?? {}).forEach((chart) => chart.dispose());
  },
  methods: {
    show(measured, predicted) {
      // Both parts of a circle; `measured` is null where only the model changed.
      if (measured) this.measured = measured;
      this.predicted = predicted;
      this.title = this.measured.title;
      this.scaleLabel = predicted.scaleLabel;
      this.against = this.measured.against.label;
      this.legend = this.measured.directions;
      this.hasFitted = predicted.directions.some((each) => each.fitted.length);
      this.draw(Boolean(measured));
      this.drawn = (this.drawn ?? 0) + 1;
      this.$el.dataset.drawn = this.drawn;
    },
    draw(whole) {
      // The curves at once; the points and the cursor when the browser has time, so that dragging does not wait for them.
      if (!this.predicted) return;
      const kept = (option, names) => whole ? option : { ...names, series: option.series.filter((each) => !STANDING.test(each.id)) };
      const now = performance.now();
      const drawPolar = () => {
        const polar = this.polarOption();
        this.charts.polar.setOption(kept(polar, { radiusAxis: polar.radiusAxis }), whole);
        this.polarAt = now;
      };
      const isSoon = !whole && now - (this.polarAt ?? 0) < POLAR_MS;
      this.charts.unrolled.setOption(kept(this.unrolledOption(), {}), whole);
      if (!isSoon) drawPolar();
      clearTimeout(this.rest);
      this.rest = setTimeout(() => {
        if (isSoon) drawPolar();
        const against = this.againstOption();
        this.charts.against.setOption(kept(against, {}), whole);
        this.mark();
      }, whole ? 0 : REST_MS);
    },
    pairs() {
      return this.measured.directions.map((each, index) => [each, this.predicted.directions[index]]);
    },
    polarOption() {
      const { centre, division, count } = this.predicted.scale;
      const turned = (line) => line.map(([angle, value]) => [value, angle]);
      const line = (id, data, color, width, z) => ({
        id, type: "line", coordinateSystem: "polar", data, showSymbol: false, silent: true, animation: false, z,
        lineStyle: { color, width },
      });
      const nominal = Array.from({ length: 181 }, (_, index) => [0, 2 * index]);
      const rings = this.pairs().flatMap(([measured, predicted], index) => [
        line(`measured${index}`, turned(measured.measuredPolar), measured.measuredColour, 4 - 1.5 * index, 2),
        line(`predicted${index}`, turned(predicted.predictedPolar), measured.predictedColour, 1.4, 3),
      ]);
      return {
        animation: false,
        polar: { center: ["50%", "50%"], radius: "78%" },
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
          ...[-1, 1].map((side) => line(`grid${side}`, nominal.map(([, angle]) => [side * count * division, angle]), FAINT, 1, 1)),
          line("nominal", nominal, MUTED, 1, 1),
          ...rings,
          {
            id: "reversals", type: "scatter", coordinateSystem: "polar", silent: true, symbolSize: 1, z: 4,
            data: this.measured.reversals.map(([slider, angle]) => ({
              value: [(count + 0.25) * division, angle], label: { show: true, formatter: String(slider), position: "inside",
                color: INK, fontSize: 11, backgroundColor: "#FFFFFFDD", padding: [1, 3], borderRadius: 3 },
            })),
          },
          {
            id: "label", type: "scatter", coordinateSystem: "polar", silent: true, symbolSize: 1, z: 5,
            data: [[count * division, 67.5, `+${count * division} µm`], [0, 67.5, "0"], [-count * division, 67.5, `\u2212${count * division} µm`]],
            label: { show: true, position: "inside", color: INK, fontSize: 11, backgroundColor: "#FFFFFFCC", padding: [0, 2],
              formatter: ({ value }) => value[2] },
          },
          { ...line("cursor", [], INK, 1, 6) },
        ],
      };
    },
    unrolledOption() {
      const line = (id, data, color, width, panel, z, extra = {}) => ({
        id, type: "line", data, xAxisIndex: panel, yAxisIndex: panel, showSymbol: false, silent: true, animation: false, z,
        lineStyle: { color, width }, ...extra,
      });
      const reversals = this.measured.reversals;
      const marks = {
        markLine: {
          silent: true, symbol: "none", animation: false, lineStyle: { color: MUTED, type: "dotted", width: 1 },
          label: { color: INK, fontSize: 11, formatter: ({ data }) => data.slider, position: "end" },
          data: reversals.map(([slider, angle]) => ({ xAxis: angle, slider: String(slider) })),
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
        series: this.pairs().flatMap(([measured, predicted], index) => [
          line(`measured${index}`, measured.measured, measured.measuredColour, 3.5 - 1.2 * index, 0, 2, index ? {} : marks),
          line(`predicted${index}`, predicted.predicted, measured.predictedColour, 1.3, 0, 3),
          line(`fitted${index}`, predicted.fitted, FITTED, 1, 1, 2),
          line(`residual${index}`, predicted.residual, measured.predictedColour, 1.4, 1, 3, index ? {} : marks),
        ]).concat([line("cursor0", [], INK, 1, 0, 6), line("cursor1", [], INK, 1, 1, 6)]),
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
        series: this.pairs().map(([measured, predicted], index) => ({
          id: `points${index}`, type: "scatter", large: true, largeThreshold: 500, data: predicted.points, symbolSize: 3, animation: false, z: 2,
          itemStyle: { color: measured.predictedColour, opacity: 0.55 }, encode: { x: 0, y: 1 },
        })).concat([{ id: "near", type: "scatter", data: [], symbolSize: 8, silent: true, animation: false, z: 5,
          itemStyle: { color: "transparent", borderColor: INK, borderWidth: 1.5 } }]),
      };
    },
    follow() {
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
      this.cursor = ((angle % TURN) + TURN) % TURN;
      if (!this.waiting) {
        this.waiting = requestAnimationFrame(() => {
          this.waiting = null;
          this.mark();
          this.tell();
        });
      }
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
    mark() {
      if (this.cursor === null || !this.predicted) return;
      const { centre, division, count } = this.predicted.scale, angle = this.cursor;
      this.charts.polar.setOption({ series: [{ id: "cursor", data: [[centre, angle], [(count + 0.25) * division, angle]] }] });
      const span = (panel) => this.charts.unrolled.getModel().getComponent("yAxis", panel).axis.scale.getExtent();
      this.charts.unrolled.setOption({
        series: [0, 1].map((panel) => ({ id: `cursor${panel}`, data: span(panel).map((value) => [angle, value]) })),
      });
      const near = this.predicted.directions.flatMap((each) =>
        each.points.filter((point) => Math.abs(((point[2] - angle + 540) % TURN) - 180) < NEAR_DEG));
      this.charts.against.setOption({ series: [{ id: "near", data: near }] });
      const reversing = this.measured.reversals.filter(([, place]) => Math.abs(place - angle) < 3).map(([slider]) => slider);
      this.readout = `${angle.toFixed(0)}°: ` + this.pairs().map(([measured, predicted]) =>
        `${measured.name} measured ${number(at(measured.measured, angle))} µm, predicted ${number(at(predicted.predicted, angle))} µm, `
        + `residual ${number(at(predicted.residual, angle), 2)} µm`).join("; ")
        + (reversing.length ? `; slider ${reversing.join(", ")} reverses here` : "");
    },
  },
};
