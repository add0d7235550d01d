/** The administrator's pages. */
import { readFile } from "node:fs/promises";
import { expect, test } from "./fixtures";

const password = "correct horse battery";

test("users are added, given another role and password, and disabled", async ({ robot, other, page }) => {
  await robot.addUser("ann", "viewer", password);
  await robot.open("Users");
  const row = page.getByRole("row", { name: "User ann" });
  await expect(row).toContainText("never");

  await row.getByLabel("Role of ann").selectOption("engineer");
  await robot.button("Set the role of ann").click();
  await expect(robot.button("Set the role of ann")).toHaveCount(0);
  await row.getByLabel("New password of ann").fill("another long password");
  await robot.button("Set the password of ann").click();
  await expect(row.getByLabel("New password of ann")).toHaveValue("");

  await other.tryLogIn("ann", password);
  await expect(other.loginForm.getByRole("alert")).toContainText("CREDENTIALS");
  await other.logIn("ann", "another long password");
  await expect(other.page.getByRole("link", { name: "Account" })).toContainText("engineer");

  await robot.button("Disable ann").click();
  await expect(row).toContainText("✕ no");
  await expect(other.loginForm).toBeVisible();
});

test("a name that is taken, a short password and the last administrator are refused in words", async ({
  robot,
  page,
}) => {
  await robot.open("Users");
  const refusal = robot.panel("Users").getByRole("alert");
  const form = page.getByRole("form", { name: "Add a user" });
  const add = async (name: string, secret: string): Promise<void> => {
    await form.getByLabel("Name").fill(name);
    await form.getByLabel("Password").fill(secret);
    await form.getByRole("button", { name: "Add user" }).click();
  };
  await add("admin", password);
  await expect(refusal).toContainText("Refused: EXISTS");
  await add("ann", "short");
  await expect(refusal).toContainText("Refused: INVALID");
  await expect(page.getByRole("row", { name: "User ann" })).toHaveCount(0);
  await robot.button("Disable admin").click();
  await expect(refusal).toContainText("Refused: LAST_ADMIN");
});

test("the audit names who did what, newest first, and goes back to the first record", async ({
  robot,
  page,
}) => {
  await robot.unlockRobot();
  await robot.open("Audit");
  const rows = robot.panel("Audit").getByRole("row");
  await expect(rows.filter({ hasText: "control" }).first()).toContainText("admin");
  await expect(rows.filter({ hasText: "login" }).first()).toBeVisible();
  const numbers = async (): Promise<number[]> => {
    const cells = await rows.locator("td:first-child").allTextContents();
    return cells.map(Number);
  };
  const seen = await numbers();
  expect(seen).toEqual([...seen].sort((a, b) => b - a));
  const older = page.getByRole("button", { name: "Older records" });
  await expect(async () => {
    if (await older.isVisible()) await older.click();
    expect(await numbers()).toContain(1);
  }).toPass();
});

test("the audit is narrowed by kind, actor and text, and saved as it is shown", async ({ robot, page }) => {
  await robot.unlockRobot();
  await robot.open("Audit");
  const audit = robot.panel("Audit");
  const kinds = () => audit.getByRole("row").locator("td:nth-child(5)").allTextContents();
  await audit.getByLabel("Kind").selectOption("login");
  await expect.poll(kinds).toEqual(["login"]);
  await audit.getByLabel("Actor").fill("nobody");
  await expect(audit).toContainText("No record fits these choices.");
  await audit.getByLabel("Actor").fill("");
  await audit.getByLabel("Kind").selectOption("");
  await audit.getByLabel("Detail has").fill("reset");
  await expect.poll(async () => new Set(await kinds())).toEqual(new Set(["verdict", "request"]));
  const saving = page.waitForEvent("download");
  await robot.button("Save as CSV").click();
  const rows = (await readFile(await (await saving).path(), "utf8")).trim().split("\r\n");
  expect(rows[0]).toBe("number,time,tick,actor,session,kind,detail,hash");
  expect(rows.length - 1).toBe((await kinds()).length);
  await page.reload();
  await expect(audit.getByLabel("Detail has")).toHaveValue("reset");
});

test("the chain of the audit is checked by the app, and a noted hash that is gone is told", async ({
  robot,
}) => {
  await robot.open("Audit");
  const result = robot.panel("Check of the chain").getByRole("status", { name: "Result of the check" });
  const check = robot.button("Check the chain");
  await expect(result).toHaveText("Not checked yet.");
  await check.click();
  await expect(result).toContainText(/✓ Unbroken up to record \d+/);
  await expect(result).toContainText(/(in agreement|not compared) with .*heads?/);
  const head = (await result.getByRole("code").textContent()) ?? "";
  expect(head).toMatch(/^[0-9a-f]{64}$/);
  await robot.panel("Check of the chain").getByLabel("Hash noted earlier").fill(head);
  await check.click();
  await expect(result).toContainText("with the hash noted earlier among them");
  await robot.panel("Check of the chain").getByLabel("Hash noted earlier").fill("a".repeat(64));
  await check.click();
  await expect(result).toContainText(/✕ BROKEN: record \d+ is missing/);
});
