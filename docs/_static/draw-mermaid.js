// Draws what stands in Mermaid on the page, in the colours that the page has, and anew when these change.
(() => {
  const drawings = [...document.querySelectorAll(".mermaid-drawing")].map((place) => [place, place.textContent.trim()]);

  const dark = matchMedia("(prefers-color-scheme: dark)");
  const isDark = () => {
    const chosen = document.body.dataset.theme;
    return chosen === "dark" || (chosen !== "light" && dark.matches);
  };
  let drawn = null;
  let count = 0;

  async function draw() {
    const theme = isDark() ? "dark" : "neutral";
    if (theme === drawn) return;
    drawn = theme;
    mermaid.initialize({ startOnLoad: false, theme, securityLevel: "strict" });
    for (const [place, text] of drawings) {
      const { svg } = await mermaid.render(`mermaid-${count++}`, text);
      place.innerHTML = svg;
    }
    document.body.dataset.drawn = theme;
  }

  draw();
  dark.addEventListener("change", draw);
  new MutationObserver(draw).observe(document.body, { attributes: true, attributeFilter: ["data-theme"] });
})();
