// Lines as Python sends them: flat arrays of x and y in turns.

// Lines come as base64 of 32-bit floats, x and y in turns: a tenth of the time of nested lists.
const unpacked = (text) => new Float32Array(Uint8Array.from(atob(text), (each) => each.charCodeAt(0)).buffer);
export const opened = (directions) => directions.map((each) =>
  Object.fromEntries(Object.entries(each).map(([name, line]) => [name, unpacked(line)])));

export function at(line, angle) {
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

export function extent(lines) {
  let low = Infinity, high = -Infinity;
  for (const line of lines) {
    for (let index = 1; index < line.length; index += 2) {
      if (line[index] < low) low = line[index];
      if (line[index] > high) high = line[index];
    }
  }
  return [low, high];
}
