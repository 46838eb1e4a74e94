// The lowest point on the screen of a round or elliptic shape, of which so much is the ball.
function low(shape, part) {
  const box = shape.getBBox(), m = shape.getScreenCTM();
  const [x, y, a, b] = [box.x + box.width / 2, box.y + box.height / 2, box.width / 2, box.height / 2];
  return m.b * x + m.d * y + m.f + part * Math.hypot(m.b * a, m.d * b);
}

// Where on the screen a line starts.
function start(line) {
  const point = line.getPointAtLength(0), m = line.getScreenCTM();
  return m.b * point.x + m.d * point.y + m.f;
}

// How high a ball is above where the ground starts, in radii of the ball as it is drawn when it is round.
function height(ball, ground) {
  const scale = ball.ownerSVGElement.getScreenCTM().a, drawn = ball.getBBox().height / 2;
  // A ball that would be a dot is drawn larger about its centre, and says its own radius or how many times as large.
  const radius = Number(ball.dataset.radius) || drawn, larger = Number(ball.dataset.larger) || drawn / radius;
  return (start(ground) - low(ball, 1 / larger)) / (scale * radius);
}
