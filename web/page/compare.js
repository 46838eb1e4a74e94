// Compare: the fitted motion of the first trial, and its readings as their time comes.

import { at, length, say } from "./elements.js";
import { COLOURS, player } from "./player.js";

const MARGIN = 16;
let [shown, beside] = [undefined, undefined];

/// The height of the fitted motion at t; at rest behind its last flight.
function height(t) {
  const { flights } = shown.motion;
  const flight = flights.findLast(({ start }) => start <= t) ?? flights[0];
  const s = Math.min(Math.max(0, t - flight.start), flight.span);
  const [a, b, c] = flight.height;
  return Math.max(0, a + b * s + c * s * s);
}

function paint(context, { width, height: tall, ink, line }, t) {
  if (shown === undefined) return [];
  const { start, points, most } = shown;
  const now = start + t;
  const y = (value) => tall - 2 * MARGIN - ((tall - 4 * MARGIN) * value) / most;
  const [left, right] = [width / 4, (3 * width) / 4];
  context.strokeStyle = line;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(0, y(0));
  context.lineTo(width, y(0));
  context.stroke();
  context.fillStyle = ink;
  context.font = "14px system-ui, sans-serif";
  context.textAlign = "center";
  context.fillText(say("compare.fitted"), left, tall - 8);
  context.fillText(say("compare.read"), right, tall - 8);
  const disc = (x, value, colour, size) => {
    context.fillStyle = colour;
    context.beginPath();
    context.arc(x, y(value) - size, size, 0, 2 * Math.PI);
    context.fill();
  };
  disc(left, height(now), COLOURS[0], 9);
  const come = points.filter(({ time }) => time <= now);
  come.forEach((point, n) => {
    const last = n === come.length - 1;
    context.globalAlpha = last ? 1 : 0.6;
    disc(right, point.height, COLOURS[1], last ? 9 : 6);
    // Its error, where the height was read, and where the fitted ball was then.
    const error = point.sigma_height;
    context.strokeStyle = ink;
    context.lineWidth = 1;
    context.beginPath();
    if (error) {
      context.moveTo(right + 16, y(point.height + error) - 9);
      context.lineTo(right + 16, y(point.height - error) - 9);
    }
    context.moveTo(left - 20, y(height(point.time)) - 9);
    context.lineTo(left - 14, y(height(point.time)) - 9);
    context.stroke();
  });
  context.globalAlpha = 1;
  const point = come.at(-1);
  const told = [say("player.height", { name: say("compare.fitted"), height: length(height(now)) })];
  if (point) told.push(say("compare.reading", { label: point.label, height: length(point.height), t: point.time.toFixed(3) }));
  return told;
}

/// A fit, or none.
export function compared(answer) {
  const motion = answer?.report.motions?.[0];
  at("compare-none").hidden = motion !== undefined;
  at("compare-how").hidden = at("beside").hidden = motion === undefined;
  shown = undefined;
  if (motion === undefined) return;
  const points = answer.points.filter(({ trial }) => trial === motion.trial);
  const [first, last] = [motion.flights[0], motion.flights.at(-1)];
  if (first === undefined) return;
  const start = Math.min(first.start, ...points.map(({ time }) => time));
  const end = Math.max(last.start + last.span, ...points.map(({ time }) => time));
  const tops = motion.flights.map(({ height: [a, b, c] }) => (b > 0 ? a - (b * b) / (4 * c) : a));
  shown = { motion, points, start, most: Math.max(1e-6, ...tops, ...points.map((point) => point.height)) };
  beside.load(end - start, true);
}

export function compare() {
  beside = player(at("beside"), paint);
  compared(undefined);
}

export const restart = () => shown && beside.load(Math.max(...shown.motion.flights.map(({ start, span }) => start + span), ...shown.points.map(({ time }) => time)) - shown.start);
export const halt = () => beside.stop();
