// Three linked charts of one circle: polar, unrolled, residual against a variable. A cursor, by mouse or arrow keys,
// marks one angle in all of them. Everything is drawn from what Python sends; nothing is computed but places on screen.
//
// ECharts draws axes, grids and reversals. Paths lie on canvases above it (Overlay), where a few thousand points take a
// millisecond, and twenty in ECharts: what was measured on one that is drawn when the scale changes, what follows a value
// that is dragged on another.
import { echarts } from "nicegui-echart";
import {
  againstOption, at, extent, FAINT, FITTED, INK, MUTED, opened, Overlay, polarOption, POLAR_SHARE, spanSeries, TURN,
  unrolledOption,
} from "hexdbb-drawing";

const NEAR_DEG = 2.0; // readings this near to the cursor are highlighted: a few in each lap
const LOOSE = 0.4; // an axis that the curves fill by less than this share is drawn anew
const NARROW = 420; // pixels below which every second angle is named

const number = (value, digits = 1) => (value >= 0 ? "+" : "\u2212") + Math.abs(value).toFixed(digits);

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
    this.under = {};
    this.over = {};
    for (const name of ["polar", "unrolled", "against"]) {
      this.charts[name] = echarts.init(this.$refs[name], null, { renderer: "canvas" });
      if (name !== "against") this.under[name] = new Overlay(this.$refs[name]);
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
      this.isRescaled ||= isScaled;
      if (measured) this.drawWhole();
      else this.fitScales(fitted !== null);
      this.drawOver();
      this.drawn = (this.drawn ?? 0) + 1;
      this.$el.dataset.drawn = this.drawn;
      window.dispatchEvent(new Event("hexdbb-shown"));
    },
    settle(points) {
      // What follows when a value that is dragged rests: every reading's residual, and axes that fit.
      this.points = points;
      this.charts.against.setOption(againstOption(this.measured, this.points));
      this.fitScales(true);
      this.drawOver();
    },
    drawWhole() {
      if (!this.predicted) return;
      this.isRescaled = true;
      this.charts.polar.setOption(polarOption(this.measured), true);
      this.spans = this.wantedSpans();
      this.charts.unrolled.setOption(unrolledOption(this.measured, this.spans, this.$refs.unrolled.clientWidth < NARROW), true);
      this.charts.against.setOption(againstOption(this.measured, this.points), true);
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
      this.isRescaled = true;
      this.charts.unrolled.setOption({ series: spanSeries(this.spans) });
    },
    axisExtent(panel) {
      return this.charts.unrolled.getModel().getComponent("yAxis", panel).axis.scale.getExtent();
    },
    drawOver() {
      // Everything that follows a value or the cursor, once for each frame of the display; what was measured if need be.
      this.frame ??= requestAnimationFrame(() => {
        this.frame = null;
        if (!this.predicted) return;
        if (this.isRescaled) this.drawMeasured();
        this.isRescaled = false;
        this.drawOverPolar();
        this.drawOverUnrolled();
        this.drawOverAgainst();
      });
    },
    placeInPolar() {
      const { clientWidth: width, clientHeight: height } = this.$refs.polar, { centre, division, count } = this.predicted.scale;
      const perUm = (POLAR_SHARE * Math.min(width, height)) / 2 / ((count + 0.25) * division - centre);
      return (angle, value, into) => {
        const radius = (value - centre) * perUm, radians = (angle * Math.PI) / 180;
        into[0] = width / 2 + radius * Math.cos(radians);
        into[1] = height / 2 - radius * Math.sin(radians);
      };
    },
    placeInPanel(panel) {
      const [low, high] = this.axisExtent(panel);
      const pixels = (point) => this.charts.unrolled.convertToPixel({ xAxisIndex: panel, yAxisIndex: panel }, point);
      const [left, bottom] = pixels([0, low]), [right, top] = pixels([TURN, high]);
      return (angle, value, into) => {
        into[0] = left + ((right - left) * angle) / TURN;
        into[1] = bottom + ((top - bottom) * (value - low)) / (high - low);
      };
    },
    drawMeasured() {
      const { polar, unrolled } = this.under, { division, count } = this.predicted.scale;
      const placed = this.placeInPolar(), ring = (value) => Array.from({ length: 362 }, (_, index) => (index % 2 ? value : index));
      polar.clear();
      for (const value of [count * division, -count * division]) polar.line(ring(value), FAINT, 1, placed);
      polar.line(ring(0), MUTED, 1, placed);
      unrolled.clear();
      const unrolledPlace = this.placeInPanel(0);
      this.measured.lines.forEach((each, index) => {
        const colour = this.measured.directions[index].measuredColour;
        polar.line(each.measuredPolar, colour, 4 - 1.5 * index, placed);
        unrolled.line(each.measured, colour, 3.5 - 1.2 * index, unrolledPlace);
      });
    },
    drawOverPolar() {
      const over = this.over.polar, { centre, division, count } = this.predicted.scale, place = this.placeInPolar();
      over.clear();
      this.predicted.lines.forEach((each, index) => over.line(each.polar, this.measured.directions[index].predictedColour, 1.4, place));
      const into = [0, 0];
      for (const value of [count * division, 0, -count * division]) {
        place(67.5, value, into);
        over.label(value ? `${value > 0 ? "+" : "\u2212"}${Math.abs(value)} µm` : "0", ...into);
      }
      if (this.cursor !== null) over.line([this.cursor, centre, this.cursor, (count + 0.25) * division], INK, 1, place);
    },
    drawOverUnrolled() {
      const over = this.over.unrolled;
      over.clear();
      [0, 1].forEach((panel) => {
        const place = this.placeInPanel(panel), [low, high] = this.axisExtent(panel);
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
