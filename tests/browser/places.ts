import path from "node:path";

/** Playwright starts in web/, see web/package.json. */
export const root = path.resolve(process.cwd(), "..");
export const reports = path.join(root, "build/reports");
export const picture = path.join(root, "docs/images/console.png");
/** Where the programs are; INTERLOCK_BIN names another build. */
export const programs = path.resolve(root, process.env.INTERLOCK_BIN ?? "build/release/bin");
