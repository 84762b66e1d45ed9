/** Hands a file to the browser to keep. */
export function download(name: string, content: Blob): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  // Some browsers begin to read only after a while.
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

/** A name as every system takes it in a file's name. */
export function plainName(name: string): string {
  return name.replace(/[^\w-]+/g, '-');
}
