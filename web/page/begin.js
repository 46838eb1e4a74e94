// The first Worker begins while the rest of the page is read: a script before all others.

/// A new Worker, which waits for the compiled part.
function begun() {
  const source = URL.createObjectURL(new Blob([WORKER], { type: "text/javascript" }));
  const worker = new Worker(source);
  URL.revokeObjectURL(source);
  return worker;
}
const first = begun();
