/** Finds the shader programs that a graphics driver refuses: what they draw is missing without a word. */

import type { WebGLProgram as ThreeProgram } from 'three';

export class Refusals {
  readonly #context: WebGL2RenderingContext;
  readonly #asked = new WeakSet<ThreeProgram>();

  constructor(context: WebGL2RenderingContext) {
    this.#context = context;
  }

  /** Those of `programs` that were drawn with for the first time and refused, in words. */
  among(programs: readonly ThreeProgram[]): string[] {
    const refused: string[] = [];
    for (const one of programs) {
      if (this.#asked.has(one)) continue;
      this.#asked.add(one);
      // three.js types it as unknown.
      const program = one.program as WebGLProgram;
      const { LINK_STATUS } = this.#context;
      // A lost context has linked nothing and is told of elsewhere. Only a refusal is worth asking why, which waits for the graphics process.
      if (this.#context.getProgramParameter(program, LINK_STATUS) || this.#context.isContextLost()) continue;
      refused.push(`${one.name}: ${this.#context.getProgramInfoLog(program)?.trim() || 'no reason given'}`);
    }
    return refused;
  }
}
