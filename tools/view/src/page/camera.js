// The camera, which looks at a point, turns round what is upright, and comes nearer or goes away.
class Camera {
  constructor(up, look, angle) {
    this.upright = unit(up);
    const aside = Math.abs(this.upright[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    this.across = unit(sub(aside, times(this.upright, dot(aside, this.upright))));
    this.depth = cross(this.across, this.upright);
    this.home = look;
    this.angle = angle;
    this.half = Math.tan(angle * Math.PI / 360);
    this.size = [1, 1];
    this.at = [0.5, 0.5, 0.5];
    this.distance = 3;
    this.goHome();
  }

  goHome() {
    const look = unit(this.home);
    this.yaw = Math.atan2(dot(look, this.across), dot(look, this.depth));
    this.pitch = Math.asin(Math.max(-1, Math.min(1, dot(look, this.upright))));
    this.aim();
  }

  // From what is looked at to the eye, and to the right and upward in the picture.
  aim() {
    const [s, c] = [Math.sin(this.yaw), Math.cos(this.yaw)];
    const level = add(times(this.across, s), times(this.depth, c));
    this.backward = add(times(level, Math.cos(this.pitch)), times(this.upright, Math.sin(this.pitch)));
    this.right = sub(times(this.across, c), times(this.depth, s));
    this.up = cross(this.backward, this.right);
    this.eye = add(this.at, times(this.backward, this.distance));
  }

  turn(dx, dy) {
    this.yaw -= dx * 0.008;
    this.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.pitch + dy * 0.008));
    this.aim();
  }

  // The angle that a pixel covers in the middle of the picture.
  get pixelAngle() {
    return 2 * this.half / this.size[1];
  }

  // So many pixels, at the distance of what is looked at.
  pan(dx, dy) {
    const pixel = this.pixelAngle * this.distance;
    this.at = add(this.at, add(times(this.right, -dx * pixel), times(this.up, dy * pixel)));
    this.aim();
  }

  // Towards a pixel, which stays where it is.
  zoom(factor, [x, y]) {
    const distance = Math.max(1e-4, Math.min(1e3, this.distance * factor));
    const [w, h] = this.size, pixel = this.pixelAngle * (this.distance - distance);
    this.at = add(this.at, add(times(this.right, (x - w / 2) * pixel), times(this.up, (h / 2 - y) * pixel)));
    this.distance = distance;
    this.aim();
  }

  // Sees all of a box, from where it is looked at now, with room for the numbers at its edges.
  fit(box) {
    this.at = between(box.least, box.most, 0.5);
    const [w, h] = this.size, room = (pixels, beside) => Math.max(0.6, 1 - 2 * beside / pixels);
    const tall = this.half * room(h, 48), wide = this.half * w / h * room(w, 58);
    let distance = 0;
    for (let bits = 0; bits < 8; bits++) {
      const p = sub(boxCorner(box, bits), this.at), near = dot(p, this.backward);
      distance = Math.max(distance, near + Math.abs(dot(p, this.up)) / tall, near + Math.abs(dot(p, this.right)) / wide);
    }
    this.distance = distance || 1;
    this.aim();
  }

  // Right and down in pixels, and how far in front of the eye.
  pixel(p) {
    const from = sub(p, this.eye), z = -dot(from, this.backward), [w, h] = this.size;
    const scale = h / (2 * this.half * z);
    return [w / 2 + dot(from, this.right) * scale, h / 2 - dot(from, this.up) * scale, z];
  }

  // The direction in which a pixel looks, one long.
  direction([x, y]) {
    const [w, h] = this.size, scale = this.pixelAngle;
    const aside = add(times(this.right, (x - w / 2) * scale), times(this.up, (h / 2 - y) * scale));
    return unit(sub(aside, this.backward));
  }

  // The matrix of all that, column by column, for what is in a box.
  matrix(box) {
    const middle = between(box.least, box.most, 0.5), radius = Math.hypot(...sub(box.most, middle)) * 1.01 + 1e-9;
    const deep = dot(sub(this.eye, middle), this.backward);
    const far = Math.max(deep + radius, this.distance * 1e-3), near = Math.max(deep - radius, far * 1e-4);
    const focal = 1 / this.half, [w, h] = this.size;
    const a = (far + near) / (far - near), b = -2 * far * near / (far - near);
    const rows = [
      [...times(this.right, focal * h / w), -dot(this.right, this.eye) * focal * h / w],
      [...times(this.up, focal), -dot(this.up, this.eye) * focal],
      [...times(this.backward, -a), dot(this.backward, this.eye) * a + b],
      [...times(this.backward, -1), dot(this.backward, this.eye)],
    ];
    return [0, 1, 2, 3].flatMap((column) => rows.map((row) => row[column]));
  }
}

