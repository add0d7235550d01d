const field = document.getElementById("filter"), count = document.getElementById("count");
const lines = [...document.querySelectorAll("[data-line]")].map((line) => [line, line.textContent.toLowerCase()]);
function show() {
  const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
  let shown = 0;
  for (const [line, text] of lines) {
    line.hidden = !words.every((word) => text.includes(word));
    shown += !line.hidden;
  }
  count.textContent = `${shown} of ${lines.length}`;
}
field.addEventListener("input", show);
field.value = decodeURIComponent(location.search.slice(3));
show();
