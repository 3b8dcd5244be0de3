// What ECharts draws: axes, grids, reversals, readings against a variable.
import { FAINT, INK, MUTED, POLAR_SHARE, TEXT, TURN } from "./style.js";

export function polarOption(measured) {
  // The radius goes from 0 to 1, whatever the scale: rings and paths, which follow it, lie on a canvas above.
  return {
    animation: false,
    polar: { center: ["50%", "50%"], radius: `${100 * POLAR_SHARE}%` },
    angleAxis: {
      min: 0, max: TURN, startAngle: 0, clockwise: false, interval: 45, axisLabel: { ...TEXT, formatter: "{value}°" },
      axisLine: { lineStyle: { color: FAINT } }, splitLine: { show: true, lineStyle: { color: FAINT } },
      axisTick: { show: false },
    },
    radiusAxis: {
      min: 0, max: 1, axisLine: { show: false }, axisTick: { show: false }, axisLabel: { show: false }, splitLine: { show: false },
    },
    series: [
      {
        id: "reversals", type: "scatter", coordinateSystem: "polar", silent: true, symbolSize: 1, z: 4,
        data: measured.reversals.map(([slider, angle]) => ({
          value: [1, angle], label: { show: true, formatter: String(slider), position: "inside",
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
    series: spanSeries(spans).map((each) => ({ ...each, ...marks })),
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
