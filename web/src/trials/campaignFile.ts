/** A campaign's table from a file. */

import { messageOf } from '../base/messageOf.ts';
import { rowsOf } from '../files/csv.ts';
import { type CampaignRow, campaignRows } from './campaignRows.ts';

/** Throws what is wrong with the file, with its name. `knows`: whether a route comes with the page. */
export async function openCampaign(
  name: string,
  bytes: Uint8Array<ArrayBuffer>,
  knows: (route: string) => boolean,
): Promise<readonly CampaignRow[]> {
  try {
    if (!/\.parquet$/i.test(name)) return campaignRows(rowsOf(new TextDecoder().decode(bytes)), knows);
    const { parquetRows } = await import('../files/parquet.ts');
    return campaignRows(await parquetRows(bytes), knows);
  } catch (cause) {
    throw new Error(`${name}: ${messageOf(cause)}`, { cause });
  }
}
