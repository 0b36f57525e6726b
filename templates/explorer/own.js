// Maps of one's own: files that are dropped on the page or chosen, sent to the program that serves it, which reads them.

/** What is sent: a line a file, its length and its name; an empty line; the files. */
const bodyOf = (files) => new Blob([`${files.map(({ name, size }) => `${size} ${name.replace(/\s+/g, " ")}\n`).join("")}\n`, ...files]);

/** Sends files and returns the map's row of the index, or throws with a reason that a person can read. */
async function send({ path, most }, files) {
  const size = files.reduce((sum, file) => sum + file.size, 0);
  if (size > most) throw new Error(`The files are larger than ${most >> 20} MB together; name them on the command line of zonal explore.`);
  const answer = await fetch(path, { method: "POST", body: bodyOf(files) }).catch(() => {
    throw new Error("The program that served this page has ended: run `zonal explore` again.");
  });
  if (answer.ok) return answer.json();
  if ([404, 405, 501].includes(answer.status)) throw new Error("This page was exported; maps are read by one that `zonal explore` serves.");
  throw new Error((await answer.text()).trim());
}

/**
 * Takes files from an input and from what is dropped anywhere on the page. `drop` is the index's word on where they go;
 * `taken(row)` is called with a map's row, `failed(text)` with a reason, `busy(names)` before either.
 */
export function listenForMaps(drop, input, { taken, failed, busy }) {
  async function take(list) {
    const files = [...list];
    if (!files.length) return;
    busy(files.map(({ name }) => name));
    try {
      taken(await send(drop, files));
    } catch (error) {
      failed(error.message);
    }
    input.value = "";
  }
  input.addEventListener("change", () => take(input.files));
  addEventListener("dragover", (event) => {
    if (![...event.dataTransfer.types].includes("Files")) return;
    event.preventDefault();
    document.body.dataset.drag = "over";
  });
  const end = () => delete document.body.dataset.drag;
  addEventListener("dragleave", (event) => event.relatedTarget === null && end());
  addEventListener("drop", (event) => {
    end();
    if (!event.dataTransfer.files.length) return;
    event.preventDefault();
    take(event.dataTransfer.files);
  });
}
