// Wakes the page: everything before this defines, this calls.
document.addEventListener("DOMContentLoaded", async () => {
  document.body.dataset.ready = "yes"; // for tests: all is there
});
