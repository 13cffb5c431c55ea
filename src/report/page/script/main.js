// Wakes the page: everything before this defines, this calls.
document.addEventListener("DOMContentLoaded", async () => {
  theme();
  contents();
  const runLine = document.getElementById("run");
  const run = runLine && JSON.parse(runLine.textContent);
  const list = document.getElementById("provenance");
  if (run && list) provenance(list, run);
  document.querySelectorAll("pre.command").forEach((pre) => pre.replaceWith(command(pre.textContent)));
  const data = await unpackJson("data");
  if (data) {
    const table = document.getElementById("cells");
    openable(table, data);
    sortable(table);
    filterable(table);
    const section = document.getElementById("costs");
    if (section) costs(section, data.costs, run?.seconds);
  }
  document.querySelectorAll("table.matrix").forEach(sortable);
  document.querySelectorAll(".wide").forEach(reachable);
  performance.mark("interactive");
  if (data) {
    for (const { name, figure: shown } of data.figures) {
      await breath();
      figure(document.querySelector(`figure[data-name="${CSS.escape(name)}"]`), shown, name);
    }
  }
  await viewer();
  document.body.dataset.ready = "yes"; // for tests: all is there
});
