/** What the kernel in the page says before anything is sent, and what the robot's kernel then says. */
import { expect, test } from "./fixtures";

test("a target beyond the range is said to be refused before it is sent, in the axis' unit", async ({
  robot,
  page,
}) => {
  const axis = robot.axis("Lateral");
  await robot.unlockRobot();
  await axis.enable();
  await axis.setHome(true);
  const asked: string[] = [];
  page.on("request", (request) => {
    if (request.method() !== "GET") asked.push(new URL(request.url()).pathname);
  });
  await axis.row.getByRole("textbox").fill("12.4");
  await expect(axis.foretelling).toContainText("RANGE would be refused: lateral 12.40 mm, allowed -49.");
  await axis.row.getByRole("textbox").fill("-3");
  await expect(axis.foretelling).toContainText("ACCEPTED would be accepted once the pedal is pressed.");
  expect(asked).toEqual([]);

  await axis.propose("12.4");
  await axis.expectRefusal("RANGE");
  await axis.propose("-3");
  await expect(robot.proposal(2)).toContainText("would be accepted once the pedal is pressed");
  await robot.pressPedal();
  await expect(robot.proposal(2)).toContainText("done");
});

test("a drag shows what its release would bring, and the code leads to its page", async ({ robot, page }) => {
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await axis.drag(3);
  await expect(axis.foretelling).toContainText("DISABLED would be refused: The axis is not enabled.");
  await page.mouse.up();
  await axis.expectRefusal("DISABLED");

  await axis.row.getByRole("textbox").fill("5");
  await axis.foretelling.getByRole("link", { name: "DISABLED" }).click();
  const code = robot.panel("Verdicts").getByRole("article", { name: "DISABLED" });
  await expect(code).toHaveAttribute("aria-current", "location");
  await expect(code).toContainText("Enable the axis.");
  await robot.panel("Codes").getByRole("searchbox", { name: "Find" }).fill("obstacle encoder");
  // The gate that blocks it, and the fault.
  await expect(robot.panel("Codes").getByRole("article")).toHaveCount(2);
  await expect(robot.panel("Faults").getByRole("article", { name: "STALL" })).toBeVisible();
});

test("each code leads to what it rests on", async ({ robot }) => {
  await robot.open("Codes");
  const stall = robot.panel("Faults").getByRole("article", { name: "STALL" });
  await expect(stall.getByRole("link", { name: "P5" })).toHaveAttribute("href", "/docs/report/trace.html#P5");
});

test("while the system is locked, the foretold refusal names the cause and its next step", async ({
  robot,
}) => {
  const axis = robot.axis("Lateral");
  await robot.expectMode("LOCKED");
  await axis.row.getByRole("textbox").fill("1");
  await expect(axis.foretelling).toContainText("MODE would be refused: LOCKED by BOOT.");
  await expect(axis.foretelling).toContainText("then press Unlock");
});

test("a button says beforehand why the kernel would refuse it, and it does", async ({ robot, page }) => {
  const axis = robot.axis("Lateral");
  const enable = axis.row.getByRole("button", { name: "Enable Lateral" });
  await expect(enable).toHaveAccessibleDescription(
    /^The kernel would refuse it, MODE: The system is LOCKED by BOOT\. .*press Unlock/,
  );
  await expect(robot.unlock).not.toHaveAttribute("data-foretold");
  await robot.button("Pull E-stop").click();
  await expect(robot.unlock).toHaveAttribute("data-foretold", "refused");
  await expect(robot.unlock).toHaveAccessibleDescription(/^The kernel would refuse it, CAUSE_PRESENT/);
  await robot.unlock.click();
  await expect(page.getByRole("alert").filter({ hasText: "Unlock refused: CAUSE_PRESENT" })).toBeVisible();

  await robot.button("Release E-stop").click();
  await robot.unlockRobot();
  await expect(enable).not.toHaveAttribute("data-foretold");
  const home = axis.row.getByRole("button", { name: "Go Home Lateral" });
  await expect(home).toHaveAccessibleDescription(/^The kernel would refuse it, DISABLED/);
  await axis.enable();
  await expect(home).not.toHaveAttribute("data-foretold");
});

test("what waits for the pedal is foretold of homing, too", async ({ robot }) => {
  const axis = robot.axis("Lateral");
  await robot.unlockRobot();
  await axis.enable();
  await axis.press("Go Home");
  await expect(robot.proposal(1)).toContainText("ACCEPTED would be accepted once the pedal is pressed.");
});

test("Why not moving? follows the newest proposal from the blocking gate to the drive", async ({ robot }) => {
  const why = robot.panel("Why not moving?");
  const gates = why.getByRole("list", { name: "Gates of Probe rotation" });
  const gate = (name: string) => gates.getByRole("listitem", { name: `Gate ${name}`, exact: true });
  const axis = robot.axis("Probe rotation");
  await robot.unlockRobot();
  await axis.enable();
  await axis.propose("40");
  await expect(gate("MODE")).toContainText("BLOCKS");
  await expect(why).toContainText("The pedal is armed: press and hold the pedal.");
  await expect(gate("PEDAL")).toContainText("closed too");
  await expect(gate("LEASE")).toContainText("follows");
  for (const name of ["ESTOP", "ENABLE", "SETPOINT", "DRIVE"]) await expect(gate(name)).toContainText("open");
  await robot.pressPedal();
  await expect(why).toContainText("Probe rotation is driven.");
  await robot.stop.click();
  await expect(why).not.toContainText("is driven");

  await why.getByRole("combobox", { name: "Axis" }).selectOption("Lateral");
  const lateral = why.getByRole("list", { name: "Gates of Lateral" });
  await expect(lateral.getByRole("listitem", { name: "Gate ENABLE" })).toContainText("closed too");
  await expect(lateral.getByRole("listitem", { name: "Gate SETPOINT" })).toContainText("judged later");
});

test("without the page's kernel the console says that it cannot foretell, and works on", async ({
  front,
  stack,
  page,
}) => {
  await page.route("**/*.wasm", (route) => route.fulfill({ status: 503 }));
  await page.reload();
  await front.logIn("admin", stack.password);
  await front.takeControl();
  await front.unlockRobot();
  const axis = front.axis("Probe rotation");
  await axis.row.getByRole("textbox").fill("5");
  await expect(axis.foretelling).toContainText("cannot be told on this page");
  await axis.propose("5");
  await axis.expectRefusal("DISABLED");
});
