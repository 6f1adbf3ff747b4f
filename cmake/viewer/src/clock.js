// The time that is shown, and how it runs.

const speeds = [1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8];

export class Clock {
  constructor(film) {
    this.first = Math.min(...film.scenes.map((s) => s.times[0]));
    this.last = Math.max(...film.scenes.map((s) => s.times[s.times.length - 1]));
    this.frames = [...new Set(film.scenes.flatMap((s) => [...s.times]))].sort((a, b) => a - b);
    this.time = this.first;
    this.playing = false;
    this.speed = 1;
    this.before = null;
  }

  /** \param now of the computer [s] */
  run(now) {
    const passed = this.before === null ? 0 : now - this.before;
    this.before = now;
    if (!this.playing) return;
    this.time += this.speed * Math.min(passed, 0.25);
    if (this.time < this.last) return;
    this.time = this.last;
    this.playing = false;
  }

  toggle() {
    if (!this.playing && this.time >= this.last) this.time = this.first;
    this.playing = !this.playing;
  }
  seek(t) {
    this.time = Math.max(this.first, Math.min(this.last, t));
  }
  /** To the next frame of any scene, or the one before. */
  step(by) {
    this.playing = false;
    let k = 0;
    while (k + 1 < this.frames.length && this.frames[k + 1] <= this.time + 1e-9) ++k;
    this.seek(this.frames[Math.max(0, Math.min(this.frames.length - 1, k + by))]);
  }
  change(by) {
    const k = Math.max(0, Math.min(speeds.length - 1, speeds.indexOf(this.speed) + by));
    this.speed = speeds[k];
  }
  get speedText() {
    return this.speed >= 1 ? `${this.speed}×` : `1/${1 / this.speed}×`;
  }
}
