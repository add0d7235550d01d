// The app's policy forbids that forms are sent; a search only goes to another page.
document.addEventListener("submit", (event) => {
  const form = event.target;
  event.preventDefault();
  const words = new URLSearchParams(new FormData(form));
  location.href = `${form.getAttribute("action") || "search.html"}?${words}`;
});
