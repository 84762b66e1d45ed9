/** The built page on an address of its own, for what measures it. */

import { preview } from 'vite';

/** Serves the page while `use` runs. */
export async function served<T>(use: (address: string) => Promise<T>): Promise<T> {
  const port = Number(process.env.MAPLESS_PAGE_PORT ?? 4173);
  const server = await preview({ preview: { host: '127.0.0.1', port } });
  try {
    const address = server.resolvedUrls?.local[0];
    if (!address) throw new Error('The page is not served: build it first, with `npm run build`.');
    return await use(address);
  } finally {
    await server.close();
  }
}
