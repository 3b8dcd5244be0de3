import { INK } from "./style.js";

export class Overlay {
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
