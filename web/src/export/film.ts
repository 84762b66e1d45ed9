/** Pictures and films of the 3D view. The view's canvas is see-through: here it stands before the page's sky. */

/** What gives its pictures away while somebody wants them, beginning with the present one; `undefined` when there will be no more. The present one is in full resolution if it is to be `fine`. */
export interface Filmed {
  film(film: ((picture: ImageBitmap | undefined) => void) | undefined, fine: boolean): void;
}

const FRAME_RATE_HZ = 30;
/** How often the recorder hands over what it has. */
const PART_MS = 250;
const BITS_PER_SECOND = 8_000_000;
/** VP9 is smaller where the browser has it. */
const KINDS = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];
const TOO_SHORT = 'It was stopped before its first picture.';

/** Whether this browser records WebM. */
export function canFilm(): boolean {
  return kind() !== undefined;
}

function kind(): string | undefined {
  return typeof MediaRecorder === 'undefined' ? undefined : KINDS.find((type) => MediaRecorder.isTypeSupported(type));
}

export class Camera {
  readonly #source: Filmed;
  readonly #plate = document.createElement('canvas');
  #recorder: MediaRecorder | undefined;
  #filming = false;
  #waiting: { resolve: () => void; reject: (error: Error) => void } | undefined;

  constructor(source: Filmed) {
    this.#source = source;
  }

  get filming(): boolean {
    return this.#filming;
  }

  /** The view as it is next drawn, in full resolution, as PNG. */
  async picture(): Promise<Blob> {
    await this.#next(true);
    return new Promise((resolve, reject) => {
      this.#plate.toBlob(
        (blob) => (blob ? resolve(blob) : reject(new Error('The browser could not make a picture of the view.'))),
        'image/png',
      );
    });
  }

  /** Films until `stop`, or until there is no view any more; resolves with the WebM. Calls `begun` once there is something in it. */
  async film(begun: () => void): Promise<Blob> {
    const mimeType = kind();
    if (!mimeType) throw new Error('This browser records no WebM video.');
    this.#filming = true;
    try {
      await this.#next(false);
    } catch (error) {
      this.#filming = false;
      throw error;
    }
    if (!this.#filming) throw new Error(TOO_SHORT);
    const stream = this.#plate.captureStream(FRAME_RATE_HZ);
    const recorder = new MediaRecorder(stream, { mimeType, videoBitsPerSecond: BITS_PER_SECOND });
    this.#recorder = recorder;
    this.#watch();
    return new Promise((resolve, reject) => {
      const parts: Blob[] = [];
      recorder.ondataavailable = ({ data }) => {
        if (data.size === 0) return;
        parts.push(data);
        if (parts.length === 1 && this.#filming) begun();
      };
      recorder.onerror = () => reject(new Error('The browser stopped recording.'));
      recorder.onstop = () => {
        const film = new Blob(parts, { type: 'video/webm' });
        if (film.size > 0) resolve(film);
        else reject(new Error(TOO_SHORT));
      };
      recorder.start(PART_MS);
    });
  }

  stop(): void {
    this.#filming = false;
    this.#recorder?.stop();
    this.#recorder = undefined;
    this.#watch();
  }

  /** Waits for the next drawing. */
  #next(fine: boolean): Promise<void> {
    return new Promise((resolve, reject) => {
      this.#waiting = { resolve, reject };
      this.#watch(fine);
    });
  }

  /** Reads the view while anybody needs it. */
  #watch(fine = false): void {
    const needed = this.#recorder !== undefined || this.#waiting !== undefined;
    this.#source.film(needed ? (picture) => (picture ? this.#take(picture) : this.#end()) : undefined, fine);
  }

  #take(picture: ImageBitmap): void {
    const plate = this.#plate;
    // A film keeps the size it began with.
    if (!this.#recorder && (plate.width !== picture.width || plate.height !== picture.height)) {
      plate.width = picture.width;
      plate.height = picture.height;
    }
    const context = plate.getContext('2d');
    if (!context) return;
    const style = getComputedStyle(document.documentElement);
    const sky = context.createLinearGradient(0, 0, 0, plate.height);
    sky.addColorStop(0, style.getPropertyValue('--sky-top').trim());
    sky.addColorStop(0.72, style.getPropertyValue('--sky-bottom').trim());
    context.fillStyle = sky;
    context.fillRect(0, 0, plate.width, plate.height);
    context.drawImage(picture, 0, 0, plate.width, plate.height);
    picture.close();
    const waiting = this.#waiting;
    if (!waiting) return;
    this.#waiting = undefined;
    this.#watch();
    waiting.resolve();
  }

  /** What is filmed so far is kept. */
  #end(): void {
    this.#waiting?.reject(new Error('there is no 3D view any more'));
    this.#waiting = undefined;
    this.stop();
  }
}
