/** Tables with commas, as campaigns write them: fields with a comma or a quote stand in quotes, which are doubled within. */

/** The fields of a row by the names of the columns. */
export type Row = Readonly<Record<string, string>>;

/** The rows by the names of the first line; throws where a row has another number of fields. */
export function rowsOf(text: string): Row[] {
  const [names = [], ...rows] = records(text);
  return rows.map((fields, index) => {
    if (fields.length !== names.length)
      throw new Error(`row ${index + 2}: ${fields.length} fields: expected ${names.length}, as the first line has`);
    return Object.fromEntries(names.map((name, at) => [name, fields[at] ?? '']));
  });
}

function records(text: string): string[][] {
  const all: string[][] = [];
  let record: string[] = [];
  // A field, and what ends it: a comma, the end of a line or of the text.
  const field = /(?:"((?:[^"]|"")*)"|([^",\r\n]*))(,|\r?\n|$)/y;
  while (field.lastIndex < text.length) {
    const from = field.lastIndex;
    const found = field.exec(text);
    if (!found) throw new Error(`row ${all.length + 1}: a quote that does not close, at character ${from + 1}`);
    record.push(found[1]?.replaceAll('""', '"') ?? found[2] ?? '');
    if (found[3] === ',') continue;
    all.push(record);
    record = [];
  }
  if (record.length > 0) all.push([...record, '']);
  return all;
}
