// The parts of the page that are of this run, and its style.

function provenance(list, run) {
  const { machine } = run;
  const sampled = run.seconds.reduce((sum, s) => sum + s, 0);
  const entries = {
    begun: run.started ? new Date(1000 * run.started).toISOString().replace(".000Z", "Z") : "not known",
    furnace: run.version,
    commit: run.commit ?? "not known",
    machine: [machine.processor, machine.architecture, machine.system, `${machine.cores} cores`].filter(Boolean).join(", "),
    threads: run.threads ? String(run.threads) : "not known",
    "seconds of sampling": sampled ? told(sampled, 3) : "not known",
  };
  list.append(...Object.entries(entries).flatMap(([key, value]) => [element("dt", {}, key), element("dd", {}, value)]));
}

// Light, dark, or as the system has it; remembered where the browser allows it.
function theme() {
  const stored = () => { try { return localStorage.getItem("furnace-theme"); } catch { return null; } };
  const remember = (value) => { try { localStorage.setItem("furnace-theme", value); } catch { /* private windows */ } };
  const button = element("button", { type: "button", class: "theme" });
  const dark = () => document.documentElement.dataset.theme === "dark"
    || (!document.documentElement.dataset.theme && matchMedia("(prefers-color-scheme: dark)").matches);
  const show = () => { button.textContent = dark() ? "Light style" : "Dark style"; };
  button.addEventListener("click", () => {
    document.documentElement.dataset.theme = dark() ? "light" : "dark";
    remember(document.documentElement.dataset.theme);
    show();
  });
  if (["light", "dark"].includes(stored())) document.documentElement.dataset.theme = stored();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", show);
  document.querySelector("header").append(button);
  show();
}

// Links to the sections, for those who want to get somewhere.
function contents() {
  const sections = [...document.querySelectorAll("main > section[id]")];
  const link = (section) => element("a", { href: `#${section.id}` }, section.querySelector("h2").textContent);
  if (sections.length > 2) document.querySelector("header").append(element("nav", { "aria-label": "sections" }, sections.map(link)));
}

// Lets the keyboard into a region that scrolls, for as long as it does.
function reachable(place) {
  const about = place.closest("figure, .details, section")?.querySelector("figcaption, h2, h3")?.textContent;
  new ResizeObserver(() => {
    const scrolls = place.scrollWidth > place.clientWidth || place.scrollHeight > place.clientHeight;
    if (!scrolls) ["tabindex", "role", "aria-label"].forEach((name) => place.removeAttribute(name));
    else for (const [name, value] of [["tabindex", 0], ["role", "group"], ["aria-label", `table: ${about}`]]) place.setAttribute(name, value);
  }).observe(place);
}
