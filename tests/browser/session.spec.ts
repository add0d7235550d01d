/** Who may enter the console, and what works for those who may not. */
import { expect, test } from "./fixtures";

test.use({ clock: "slow" });

const password = "correct horse battery";

test("before login only the system's state and STOP are there", async ({ front, stack, page }) => {
  await front.expectMode("LOCKED");
  await expect(page.getByRole("banner").getByText("BOOT")).toBeVisible();
  await expect(front.loginForm).toBeVisible();
  await expect(front.panel("Motors")).toHaveCount(0);
  await expect(front.unlock).toHaveCount(0);
  const answer = await page.request.get(new URL("/api/motors", stack.url).href);
  expect([answer.status(), (await answer.json()).code]).toEqual([401, "LOGIN"]);
});

test("the header tells the time of day here, with its zone", async ({ front, page }) => {
  await front.expectMode("LOCKED");
  const clock = page.getByRole("banner").getByRole("time");
  await expect(clock).toHaveText(/^\d\d:\d\d:\d\d UTC$/);
  const seen = (await clock.textContent()) ?? "";
  await expect(clock).not.toHaveText(seen);
});

test("the keyboard alone logs in, and a reload keeps the session", async ({ front, stack, page }) => {
  await expect(front.loginForm.getByLabel("Name")).toBeFocused();
  await page.keyboard.type("admin");
  await page.keyboard.press("Tab");
  await page.keyboard.type(stack.password);
  await page.keyboard.press("Enter");
  await expect(front.panel("Motors")).toBeVisible();
  await page.reload();
  await expect(front.panel("Motors")).toBeVisible();
});

test("a wrong password is refused in words, and too many logins at once have to wait", async ({
  front,
  stack,
  page,
}) => {
  const refusal = front.loginForm.getByRole("alert");
  await front.tryLogIn("admin", "wrong password");
  await expect(refusal).toContainText("Not logged in: CREDENTIALS");
  await expect(front.loginForm.getByLabel("Password")).toHaveValue("");

  const submit = front.loginForm.getByRole("button", { name: "Log in" });
  const wait = page.getByRole("status", { name: "Time to wait" });
  // Takes a flood of logins from elsewhere.
  const full = {
    type: "about:blank",
    title: "Too Many Requests",
    status: 429,
    code: "BACK_OFF",
    detail: "Too many logins are under way.",
    next_step: "Try again in 1 s.",
  };
  await page.route(
    "**/api/login",
    (route) =>
      route.fulfill({
        status: full.status,
        headers: { "Retry-After": "3" },
        contentType: "application/problem+json",
        body: JSON.stringify(full),
      }),
    { times: 1 },
  );
  await front.tryLogIn("admin", stack.password);
  await expect(refusal).toContainText("BACK_OFF");
  await expect(wait).toContainText(/Another attempt in \d+ s/);
  await expect(submit).toBeDisabled();

  await expect(wait).toBeEmpty();
  await front.logIn("admin", stack.password);
});

for (const [way, press] of [
  ["STOP", "click"],
  ["Esc", "key"],
] as const) {
  test(`${way} on the login page stops somebody else's move`, async ({ robot, other }) => {
    const axis = robot.axis("Probe rotation");
    await robot.unlockRobot();
    await axis.enable();
    await axis.propose("40");
    await robot.pressPedal();
    await other.expectMode("MOTION");

    if (press === "click") await other.stop.click();
    else await other.page.keyboard.press("Escape");

    await expect(other.stopAnswer).toHaveText("STOP accepted");
    await robot.expectMode("READY");
    await expect(robot.proposal(1)).toContainText("aborted");
  });
}

test("STOP is answered while every other request hangs", async ({ robot, page }) => {
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await axis.enable();
  await axis.propose("40");
  await robot.pressPedal();
  await expect(robot.proposal(1)).toContainText("executing");
  const hanging: string[] = [];
  const answered: string[] = [];
  page.on("response", (response) => answered.push(new URL(response.url()).pathname));
  await page.route(/\/api\/(?!stop$)/, (route) => void hanging.push(new URL(route.request().url()).pathname));
  await robot.button("Jam Yaw").click();
  await expect.poll(() => hanging).toContain("/api/bench/jam");
  await robot.stop.click();
  await expect(robot.stopAnswer).toHaveText("STOP accepted");
  expect(answered).not.toContain("/api/bench/jam");
  await expect(robot.proposal(1)).toContainText("aborted");
  await page.unrouteAll({ behavior: "ignoreErrors" });
});

test("the data of the login page age by name when the app falls silent", async ({ front, stack }) => {
  await front.expectMode("LOCKED");
  stack.signalApp("SIGSTOP");
  try {
    await front.expectMode("UNKNOWN");
  } finally {
    stack.signalApp("SIGCONT");
  }
  await front.expectMode("LOCKED");
});

test("logging out ends the session and releases control", async ({ robot, other, stack }) => {
  await robot.button("Log out").click();
  await expect(robot.loginForm).toBeVisible();
  await expect(robot.panel("Motors")).toHaveCount(0);
  await other.logIn("admin", stack.password);
  await expect(other.control).toHaveText("Nobody is in control");
});

test("a session that the administrator ends returns to login with words", async ({ robot, other }) => {
  await robot.addUser("ann", "engineer", password);
  await other.logIn("ann", password);
  await robot.open("Users");
  await robot.button("Disable ann").click();
  await expect(other.page.getByRole("alert").filter({ hasText: "Your session ended" })).toContainText(
    "Log in again.",
  );
  await expect(other.panel("Motors")).toHaveCount(0);
  await other.tryLogIn("ann", password);
  await expect(other.loginForm.getByRole("alert")).toContainText("CREDENTIALS");
});

test("one's own password is changed by knowing it", async ({ robot, stack, page }) => {
  await robot.open("Account");
  const form = page.getByRole("form", { name: "Change the password" });
  const change = async (current: string): Promise<void> => {
    await form.getByLabel("Current password").fill(current);
    await form.getByLabel("New password", { exact: true }).fill(password);
    await form.getByLabel("New password again").fill(password);
    await form.getByRole("button", { name: "Change password" }).click();
  };
  await change("not the password");
  await expect(form.getByRole("alert")).toContainText("Not changed: CREDENTIALS");
  await change(stack.password);
  await expect(form.getByRole("status")).toHaveText("The password is changed.");

  await robot.button("Log out").click();
  await robot.tryLogIn("admin", stack.password);
  await expect(robot.loginForm.getByRole("alert")).toContainText("CREDENTIALS");
  await robot.logIn("admin", password);
});

test("one's own sessions are listed, and ended one by one or all but this one", async ({
  robot,
  other,
  stack,
}) => {
  await robot.open("Account");
  const sessions = robot.panel("Account").getByRole("region", { name: "Sessions" });
  const rows = sessions.getByRole("row", { name: /^Session \d+$/ });
  const ended = other.page.getByRole("alert").filter({ hasText: "Your session ended" });
  const all = sessions.getByRole("button", { name: "End all others" });
  await expect(rows).toHaveCount(1);
  await expect(rows.first()).toContainText(/127\.0\.0\.1:\d+.*● this one/);
  await expect(all).toBeDisabled();
  for (const end of [sessions.getByRole("button", { name: /^End session \d+$/ }), all]) {
    await other.logIn("admin", stack.password);
    await expect(rows).toHaveCount(2);
    await end.click();
    await expect(rows).toHaveCount(1);
    await expect(ended).toBeVisible();
  }
  await expect(robot.panel("Account")).toBeVisible();
});
