// Tables sort by a click on a column's head; the filter hides the checks that lack its words; a link opens what its
// target stands in.
for (const table of document.querySelectorAll("table.sortable")) {
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = head.textContent;
    head.replaceChildren(button);
    button.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const key = (row) => row.cells[column].dataset.sort ?? row.cells[column].textContent.trim();
      const rows = [...table.tBodies[0].rows];
      rows.sort((a, b) => {
        const [p, q] = [key(a), key(b)];
        const numbers = p !== "" && q !== "" && !isNaN(p) && !isNaN(q);
        return (down ? -1 : 1) * (numbers ? p - q : p.localeCompare(q, undefined, { numeric: true }));
      });
      table.tBodies[0].append(...rows);
    });
  });
}
const opened = () => {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  for (let around = target; around; around = around.parentElement) if (around.tagName === "DETAILS") around.open = true;
  target.scrollIntoView();
};
addEventListener("hashchange", opened);
opened();
const filter = document.getElementById("filter");
if (filter) filter.addEventListener("input", () => {
  const words = filter.value.toLowerCase().split(/\s+/);
  let shown = 0;
  for (const check of document.querySelectorAll("#checks > details")) {
    const text = check.firstElementChild.textContent.toLowerCase();
    check.hidden = !words.every((word) => text.includes(word));
    shown += !check.hidden;
  }
  document.getElementById("shown").textContent = `${shown} shown`;
});
