// The charts of a run and the table of its nodes. Everything is drawn from what Python sends; points are only ever added
// to the polar trace until another circle begins.
import { echarts } from "nicegui-echart";

const INK = "#1F2933", FAINT = "#D9D9D9", MUTED = "#595959", BAR = "#004B76", LIGHT = "#56B4E9";
const TEXT = { color: INK, fontSize: 12 };
const TURN = 360;
const AXES = ["1", "2", "3", "4", "5", "6"];

const value = (name, more = {}) => ({ type: "value", name, nameLocation: "middle", nameGap: 40, nameTextStyle: TEXT, axisLabel: TEXT,
  splitNumber: 3, splitLine: { lineStyle: { color: FAINT } }, ...more });
const category = (name, data) => ({ type: "category", data, name, nameLocation: "middle", nameGap: 24, nameTextStyle: TEXT,
  axisLabel: { ...TEXT, hideOverlap: true }, axisTick: { show: false }, axisLine: { lineStyle: { color: MUTED } } });
const frame = { left: 58, right: 14, top: 10, bottom: 40 };

export default {
  template: `
    <div class="wb-live-charts">
      <figure class="wb-card wb-live-polar">
        <figcaption class="wb-chart-title"><b>{{ title }}</b><span>{{ scaleLabel }}</span></figcaption>
        <div ref="polar" class="wb-canvas" role="img" :aria-label="'Polar trace of the readings, ' + title"></div>
        <p class="wb-legend"><span v-for="each in legend"><i :style="{ background: each.colour }"></i>{{ each.name }}</span>
          <span>readings as they come, set-up error included</span></p>
      </figure>
      <section class="wb-card wb-live-nodes" aria-label="Nodes">
        <h2>Nodes</h2>
        <table>
          <thead><tr><th scope="col">node</th><th scope="col">NMT</th><th scope="col">state</th><th scope="col" class="wb-figures">heartbeat, ms ago</th>
            <th scope="col" class="wb-figures">SYNCs unanswered</th></tr></thead>
          <tbody>
            <template v-for="each in nodes">
              <tr :data-node="each.label"><th scope="row">{{ each.label }}</th>
                <td :class="{ 'wb-bad': each.nmt !== 'operational' }">{{ each.nmt }}</td><td>{{ each.state }}</td>
                <td class="wb-figures">{{ each.heartbeat_ms ?? "–" }}</td><td class="wb-figures">{{ each.unanswered }}</td></tr>
              <tr v-if="each.emergency"><td colspan="5" class="wb-bad">{{ each.emergency }}</td></tr>
            </template>
          </tbody>
        </table>
        <p v-if="!nodes.length" class="wb-small">Not configured yet.</p>
        <p v-for="each in notes" class="wb-small">note: {{ each }}</p>
      </section>
      <figure class="wb-card">
        <figcaption class="wb-chart-title"><b>Cycle times</b><span data-mark="times">{{ timesLabel }}</span></figcaption>
        <div ref="times" class="wb-canvas" role="img" :aria-label="'Histogram of cycle times: ' + timesLabel"></div>
      </figure>
      <figure class="wb-card">
        <figcaption class="wb-chart-title"><b>Missed SYNCs</b><span>{{ gapsLabel }}</span></figcaption>
        <div ref="gaps" class="wb-canvas" role="img" :aria-label="'Histogram of missed SYNCs: ' + gapsLabel"></div>
      </figure>
      <figure class="wb-card">
        <figcaption class="wb-chart-title"><b>Following error</b><span data-mark="following">{{ followingLabel }}</span></figcaption>
        <div ref="following" class="wb-canvas" role="img" :aria-label="'Following error of the axes: ' + followingLabel"></div>
      </figure>
    </div>`,
  data: () => ({ title: "Before the first circle", scaleLabel: "", legend: [], nodes: [], notes: [], timesLabel: "", gapsLabel: "",
    followingLabel: "" }),
  async mounted() {
    await new Promise((resolve) => setTimeout(resolve, 0));
    this.charts = {};
    this.lines = new Map();
    for (const name of ["polar", "times", "gaps", "following"]) {
      this.charts[name] = echarts.init(this.$refs[name], null, { renderer: "canvas" });
    }
    this.observer = new ResizeObserver(() => Object.values(this.charts).forEach((chart) => chart.resize()));
    this.observer.observe(this.$el);
    this.$el.dataset.points = 0;
    this.$emit("ready");
  },
  beforeUnmount() {
    this.observer?.disconnect();
    Object.values(this.charts ?? {}).forEach((chart) => chart.dispose());
  },
  methods: {
    show(state) {
      for (const name of ["nodes", "notes", "timesLabel", "gapsLabel"]) this[name] = state[name];
      const drawn = JSON.stringify([state.times, state.gaps, state.following, state.largest]);
      if (drawn === this.drawn) return;
      this.drawn = drawn;
      this.drawTimes(state);
      this.drawGaps(state);
      this.drawFollowing(state);
    },
    drawTimes({ times, cycle }) {
      this.charts.times.setOption({
        animation: false, grid: frame,
        xAxis: category(`ms since the SYNC before (planned ${cycle})`, times.map(([edge]) => edge.toFixed(1))),
        yAxis: { ...value("cycles"), type: "log", min: 0.5, startValue: 0.5, axisLabel: { ...TEXT, formatter: (count) => count < 1 ? "" : count } },
        series: [{ type: "bar", data: times.map(([, count]) => count || null), barCategoryGap: "8%", itemStyle: { color: BAR } }],
      });
    },
    drawGaps({ gaps }) {
      this.charts.gaps.setOption({
        animation: false, grid: frame,
        xAxis: category("missed in a row", gaps.length ? gaps.map(([length]) => length) : ["none"]),
        yAxis: value("times", { minInterval: 1 }),
        series: [{ type: "bar", data: gaps.map(([, count]) => count), barMaxWidth: 40, itemStyle: { color: BAR } }],
      });
    },
    drawFollowing({ following, largest, limit }) {
      const most = Math.max(...largest);
      this.followingLabel = most
        ? `largest ${most.toFixed(3)} mm, slider ${1 + largest.indexOf(most)}; the run stops at ${limit} mm` : "on circles only";
      const bars = (name, data, color) => ({ name, type: "bar", data, barGap: "0%", itemStyle: { color } });
      this.charts.following.setOption({
        animation: false, grid: { ...frame, top: 30 }, legend: { top: 0, textStyle: TEXT, itemHeight: 8, itemWidth: 16 },
        xAxis: category("slider", AXES), yAxis: value("mm"),
        series: [bars("last samples", following, LIGHT), bars("largest so far", largest, BAR)],
      });
    },
    grow({ anew, title, scaleLabel, scale, lines }) {
      if (anew) this.lines.clear();
      this.title = title;
      this.scaleLabel = scaleLabel;
      for (const each of lines) {
        if (!this.lines.has(each.id)) this.lines.set(each.id, { ...each, points: [] });
        const points = this.lines.get(each.id).points;
        for (const point of each.points) points.push(point);
      }
      const known = new Map([...this.lines.values()].map(({ name, colour }) => [name, { name, colour }]));
      this.legend = [...known.values()];
      this.charts.polar.setOption(this.polarOption(scale), anew);
      this.$el.dataset.points = [...this.lines.values()].reduce((sum, each) => sum + each.points.length, 0);
    },
    polarOption({ centre, division, count }) {
      const line = (id, data, color, width, z) => ({ id, type: "line", coordinateSystem: "polar", data, showSymbol: false, silent: true,
        animation: false, z, lineStyle: { color, width }, itemStyle: { color } });
      const ring = (radius) => Array.from({ length: 181 }, (_, index) => [radius, 2 * index]);
      return {
        animation: false,
        polar: { center: ["50%", "50%"], radius: "78%" },
        angleAxis: { min: 0, max: TURN, startAngle: 0, clockwise: false, interval: 45, axisLabel: { ...TEXT, formatter: "{value}°" },
          axisLine: { lineStyle: { color: FAINT } }, splitLine: { show: true, lineStyle: { color: FAINT } }, axisTick: { show: false } },
        radiusAxis: { min: centre, max: (count + 0.25) * division, axisLine: { show: false }, axisTick: { show: false }, z: 5,
          axisLabel: { show: false }, splitLine: { show: false } },
        series: [
          ...[-1, 1].map((side) => line(`grid${side}`, ring(side * count * division), FAINT, 1, 1)),
          line("nominal", ring(0), MUTED, 1, 1),
          ...[...this.lines.values()].map((each, index) => line(`sweep${each.id}`, each.points, each.colour, index ? 1.8 : 4, 3 + index)),
          {
            id: "label", type: "scatter", coordinateSystem: "polar", silent: true, symbolSize: 1, z: 5,
            data: [[count * division, 67.5, `+${count * division} µm`], [0, 67.5, "0"], [-count * division, 67.5, `\u2212${count * division} µm`]],
            label: { show: true, position: "inside", color: INK, fontSize: 11, backgroundColor: "#FFFFFFCC", padding: [0, 2],
              formatter: ({ value }) => value[2] },
          },
        ],
      };
    },
  },
};
