// Wakes the page: everything before this defines, this calls.
document.addEventListener("DOMContentLoaded", async () => {
  await viewer();
  document.body.dataset.ready = "yes"; // for tests: all is there
});
