/** Places on the ground. World frame: x east, y north, in metres. */

export interface Place {
  readonly x: number;
  readonly y: number;
}

export interface Heading extends Place {
  /** Counter-clockwise from east, in radians. */
  readonly heading_rad: number;
}
