// What ECharts draws: axes, grids, measured paths, reversals, readings against a variable.
import { pairs } from "./lines.js";
import { FAINT, INK, MUTED, POLAR_SHARE, TEXT, TURN } from "./style.js";

export function polarOption(measured, predicted) {
  const { centre, division, count } = predicted.scale;
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
      ...measured.lines.map((each, index) => line(`measured${index}`, pairs(each.measuredPolar).map(([angle, value]) => [value, angle]),
        measured.directions[index].measuredColour, 4 - 1.5 * index, 2)),
      {
        id: "reversals", type: "scatter", coordinateSystem: "polar", silent: true, symbolSize: 1, z: 4,
        data: measured.reversals.map(([slider, angle]) => ({
          value: [(count + 0.25) * division, angle], label: { show: true, formatter: String(slider), position: "inside",
            color: INK, fontSize: 11, backgroundColor: "#FFFFFFDD", padding: [1, 3], borderRadius: 3 },
        })),
      },
    ],
  };
}

export function unrolledOption(measured, spans, narrow) {
  const marks = {
    markLine: {
      silent: true, symbol: "none", animation: false, lineStyle: { color: MUTED, type: "dotted", width: 1, opacity: 1 },
      label: { color: INK, fontSize: 11, formatter: ({ data }) => data.slider, position: "end" },
      data: measured.reversals.map(([slider, angle]) => ({ xAxis: angle, slider: String(slider) })),
    },
  };
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
      ...measured.lines.map((each, index) => ({
        id: `measured${index}`, type: "line", data: pairs(each.measured), xAxisIndex: 0, yAxisIndex: 0, showSymbol: false,
        silent: true, animation: false, z: 2, lineStyle: { color: measured.directions[index].measuredColour, width: 3.5 - 1.2 * index },
      })),
      ...spanSeries(spans).map((each) => ({ ...each, ...marks })),
    ],
  };
}

export function spanSeries(spans) {
  // Lines that nobody sees: ECharts finds round limits for them.
  return spans.map((span, panel) => ({ id: `span${panel}`, type: "line", xAxisIndex: panel, yAxisIndex: panel, silent: true,
    animation: false, showSymbol: false, lineStyle: { opacity: 0 }, data: [[0, span[0]], [TURN, span[1]]] }));
}

export function againstOption(measured, every) {
  const unit = measured.against.unit;
  return {
    animation: false,
    grid: { left: 58, right: 14, top: 12, bottom: 40 },
    xAxis: { type: "value", scale: true, name: unit ? `in ${unit}` : "", nameLocation: "middle", nameGap: 24, nameTextStyle: TEXT,
      axisLabel: { ...TEXT, hideOverlap: true }, splitLine: { show: false }, axisLine: { onZero: false, lineStyle: { color: MUTED } } },
    yAxis: { type: "value", scale: true, name: "residual, µm", nameLocation: "middle", nameGap: 40, nameTextStyle: TEXT,
      axisLabel: TEXT, splitNumber: 4, splitLine: { lineStyle: { color: FAINT } } },
    series: every.map((points, index) => ({
      id: `points${index}`, type: "scatter", large: true, largeThreshold: 500, data: points, symbolSize: 3, animation: false, z: 2,
      itemStyle: { color: measured.directions[index]?.predictedColour, opacity: 0.55 }, encode: { x: 0, y: 1 },
    })),
  };
}
