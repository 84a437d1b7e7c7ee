// Shows what is chosen, moves sliders, sorts tables. Without it the page shows its defaults.
"use strict";
document.documentElement.classList.add("js");

const all = (selector, within = document) => [...within.querySelectorAll(selector)];
const chooser = (kind) => all(`select[data-choose="${kind}"]`);
const chosen = (kind) => chooser(kind)[0]?.value;

function showChoice() {
  const [output, measure] = [chosen("output"), chosen("measure")];
  for (const element of all("[data-output]")) {
    const { output: own, measure: by } = element.dataset;
    element.hidden = own !== output || (by !== undefined && by !== measure);
  }
}

function showRun(scene, anchor) {
  for (const article of all("article.run")) {
    if (article.dataset.scene === scene) article.classList.toggle("unchosen", article.id !== anchor);
  }
}

// A link to a run chooses it.
function followHash() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target?.matches("article.run")) return;
  for (const select of chooser("run")) {
    if (select.dataset.scene === target.dataset.scene) select.value = target.id;
  }
  showRun(target.dataset.scene, target.id);
  target.scrollIntoView();
  target.focus({ preventScroll: true });
}

for (const select of [...chooser("output"), ...chooser("measure")]) select.addEventListener("change", showChoice);
for (const select of chooser("run")) {
  select.addEventListener("change", () => showRun(select.dataset.scene, select.value));
  showRun(select.dataset.scene, select.value);
}
addEventListener("hashchange", followHash);
// A second click on the same link changes no hash.
for (const link of all('a[href^="#run-"]')) {
  link.addEventListener("click", () => { if (link.hash === location.hash) followHash(); });
}

for (const slide of all(".slide")) {
  const [range, stack] = [slide.querySelector("input"), slide.querySelector(".stack")];
  if (!range) continue;
  const cut = () => stack.style.setProperty("--cut", `${range.value}%`);
  const follow = (event) => {
    const box = stack.getBoundingClientRect();
    range.value = ((event.clientX - box.left) / box.width) * 100;
    cut();
  };
  range.addEventListener("input", cut);
  const stop = () => removeEventListener("pointermove", follow);
  stack.addEventListener("pointerdown", (event) => {
    follow(event);
    addEventListener("pointermove", follow);
    for (const end of ["pointerup", "pointercancel"]) addEventListener(end, stop, { once: true });
  });
  cut();
}

// Numbers sort by their full value, the rest as text; what is not known comes last either way.
function sort(table, column, descending) {
  const key = (row) => {
    const cell = row.cells[column];
    const value = cell.dataset.value;
    if (value !== undefined) return Number(value);
    return cell.classList.contains("n") ? NaN : cell.textContent.trim();
  };
  const compare = (a, b) => {
    if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
    const order = typeof a === "number" ? a - b : a.localeCompare(b, undefined, { numeric: true });
    return descending ? -order : order;
  };
  const body = table.tBodies[0];
  const rows = [...body.rows].map((row) => [key(row), row]);
  rows.sort(([a], [b]) => compare(a, b));
  body.append(...rows.map(([, row]) => row));
}

for (const table of all("table.sortable")) {
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const descending = head.getAttribute("aria-sort") === "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", descending ? "descending" : "ascending");
      sort(table, column, descending);
    });
  });
}

showChoice();
followHash();
