import "./design/font.css";
import "./design/tokens.css";
import "./design/base.css";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { App } from "./app";
import { keepPageOnDrop } from "./design/keepPage";
import { startFeed } from "./state/feed";

const root = document.getElementById("console");
if (root === null) throw new Error("index.html has no element with the id console");
keepPageOnDrop();
startFeed();
createRoot(root).render(
  <StrictMode>
    <App />
  </StrictMode>,
);
