// Uses the page as a reader would, and sends what it finds to the page around it.
(async () => {
  const found = { faults: window.faults, overflow: [] };
  const every = (selector, within = document) => [...within.querySelectorAll(selector)];
  const isShown = (element) => element.getClientRects().length > 0;
  const shown = (selector, of) => [...new Set(every(selector).filter(isShown).map(of))];
  const fits = (when) => {
    const { scrollWidth, clientWidth } = document.documentElement;
    if (scrollWidth > clientWidth) found.overflow.push(`${when}: ${scrollWidth} > ${clientWidth}`);
  };
  const choose = (select, value) => {
    select.value = value;
    select.dispatchEvent(new Event("change", { bubbles: true }));
  };
  const outputs = () => shown("[data-output]", (element) => element.dataset.output);
  const measures = () => shown("[data-measure]", (element) => element.dataset.measure);
  const runs = () => shown("article.run", (element) => element.id);
  const frame = () => new Promise((done) => setTimeout(done, 50));

  try {
    fits("at first");
    const charts = shown(".cost .chart", (element) => element.className);
    found.first = { outputs: outputs(), measures: measures(), runs: runs(), charts };

    const links = every("a.point");
    const lost = links.map((link) => link.getAttribute("href")).filter((href) => !document.querySelector(href));
    found.points = { some: links.length > 20, lost };
    const named = (element) => element.alt || element.getAttribute("aria-label") || element.labels?.[0]?.textContent;
    found.unnamed = every("img, svg:not([aria-hidden]), input, select, a.point, [role=img]")
      .filter((element) => !named(element))
      .map((element) => element.outerHTML.slice(0, 100));

    const slide = every(".slide").find(isShown);
    const [range, stack] = [slide.querySelector("input"), slide.querySelector(".stack")];
    const cut = () => getComputedStyle(stack).getPropertyValue("--cut").trim();
    const slider = { half: cut() };
    range.value = 20;
    range.dispatchEvent(new Event("input", { bubbles: true }));
    slider.moved = cut();
    const box = stack.getBoundingClientRect();
    const point = (kind, share) => new PointerEvent(kind, { bubbles: true, clientX: box.left + box.width * share });
    stack.dispatchEvent(point("pointerdown", 0.3));
    stack.dispatchEvent(point("pointermove", 0.75));
    slider.dragged = cut();
    stack.dispatchEvent(point("pointerup", 0.75));
    stack.dispatchEvent(point("pointermove", 0.1));
    slider.after = cut();
    slider.uncut = getComputedStyle(stack.querySelector(".own")).clipPath.includes("75%");
    found.slider = slider;

    const select = document.querySelector('select[data-choose="run"]');
    choose(select, "run-3");
    const run = { chosen: runs() };
    location.hash = "#run-2";
    await frame();
    Object.assign(run, { linked: runs(), select: select.value });
    every('a.point[href="#run-5"]').find(isShown).click();
    await frame();
    run.clicked = runs();
    found.run = run;

    const table = every(".errors table").find(isShown);
    const heads = [...table.tHead.rows[0].cells];
    const column = heads.findIndex((head) => head.textContent === "relMSE");
    const values = () => [...table.tBodies[0].rows].map((row) => Number(row.cells[column].dataset.value));
    const rises = (numbers) => numbers.every((number, at) => at === 0 || numbers[at - 1] <= number);
    const button = heads[column].querySelector("button");
    button.click();
    const sorted = { rising: rises(values()), aria: [heads[column].getAttribute("aria-sort")] };
    button.click();
    sorted.falling = rises(values().reverse());
    sorted.aria.push(heads[column].getAttribute("aria-sort"));
    sorted.rows = values().length;
    found.sorted = sorted;

    for (const details of every("details")) details.open = true;
    fits("with all details open");
    choose(document.querySelector('select[data-choose="output"]'), "direct");
    choose(document.querySelector('select[data-choose="measure"]'), "flip");
    found.chosen = { outputs: outputs(), measures: measures() };
    fits("with another output");
  } catch (error) {
    found.faults.push(`in the test: ${error.stack}`);
  }
  const entries = performance.getEntriesByType("resource").map((entry) => entry.name);
  found.loaded = entries.filter((name) => !name.startsWith("data:"));
  parent.postMessage(JSON.stringify(found), "*");
})();
