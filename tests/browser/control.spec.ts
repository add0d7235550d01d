/** One session moves the robot; everybody sees which. */
import { expect, test } from "./fixtures";

test.use({ clock: "slow" });

const password = "correct horse battery";

test("control is handed over to whoever requests it, and that ends the motion", async ({ robot, other }) => {
  const axis = robot.axis("Probe rotation");
  await robot.addUser("ann", "engineer", password);
  await robot.unlockRobot();
  await axis.enable();
  await axis.propose("40");
  await robot.pressPedal();

  await other.logIn("ann", password);
  await expect(other.control).toHaveText("admin is in control");
  await expect(other.panel("Motors")).toContainText("admin is in control: request control.");
  await expect(other.button("Enable Yaw")).toBeDisabled();
  await expect(other.button("Enable Yaw")).toHaveAttribute("title", "admin is in control: request control.");
  await other.button("Request control").click();
  await expect(other.button("Withdraw request")).toBeVisible();

  await robot.button("Hand over to ann").click();
  await expect(other.control).toHaveText("You are in control");
  await expect(robot.control).toHaveText("ann is in control");
  await robot.expectMode("READY");
  await expect(robot.proposal(1)).toContainText("aborted");
  await expect(robot.button("Disable Probe rotation")).toBeDisabled();
  await other.axis("Probe rotation").press("Disable");
  await axis.expectState("DISABLED");
});

test("an administrator takes control, after a question", async ({ front, other, stack }) => {
  await front.logIn("admin", stack.password);
  await front.addUser("ann", "engineer", password);
  await other.logIn("ann", password);
  await other.takeControl();

  await front.button("Take control").click();
  const question = front.panel("Take control from ann?");
  await expect(question).toContainText("Motion ends");
  await question.getByRole("button", { name: "Cancel" }).click();
  await expect(other.control).toHaveText("You are in control");

  await front.button("Take control").click();
  await question.getByRole("button", { name: "Take control" }).click();
  await expect(front.control).toHaveText("You are in control");
  await expect(other.control).toHaveText("admin is in control");
  await expect(other.button("Take control")).toHaveCount(0);
});

test("a second engineer watches a move live, and cannot write past the holder", async ({ robot, other }) => {
  const axis = robot.axis("Probe rotation");
  const watched = other.axis("Probe rotation");
  await robot.addUser("ann", "engineer", password);
  await robot.unlockRobot();
  await axis.enable();
  await axis.propose("40");
  await other.logIn("ann", password);
  await robot.pressPedal();
  await other.expectMode("MOTION");
  await expect.poll(() => watched.counts()).toBeGreaterThan(10);
  for (const name of ["Disable Probe rotation", "Enable Yaw", "Home all", "Zero all"])
    await expect(other.button(name)).toBeDisabled();
  await expect(watched.row.getByRole("textbox")).toBeDisabled();

  const answers = await other.page.evaluate(async () => {
    const writes: [path: string, body: object][] = [
      ["/api/motors/probe_rotation/disable", {}],
      ["/api/motors/yaw/enable", {}],
      ["/api/proposals", { slot: 0, target: 1 }],
      ["/api/jog", { slot: 0, direction: "positive" }],
      ["/api/reset", {}],
    ];
    const asked = writes.map(async ([path, body]) => {
      const response = await fetch(path, { method: "POST", body: JSON.stringify(body) });
      return [path, response.status, (await response.json()).code];
    });
    return Promise.all(asked);
  });
  for (const answer of answers) expect(answer.slice(1)).toEqual([409, "CONTROL"]);
  await expect(robot.proposal(1)).toContainText(/executing|done/);
  await expect(robot.proposal(2)).toHaveCount(0);
  await robot.axis("Yaw").expectState("DISABLED");
});

test("a request is withdrawn, and control that was released is free", async ({ robot, other }) => {
  await robot.addUser("ann", "engineer", password);
  await other.logIn("ann", password);
  await other.button("Request control").click();
  await expect(robot.button("Hand over to ann")).toBeVisible();
  await other.button("Withdraw request").click();
  await expect(robot.button("Hand over to ann")).toHaveCount(0);
  await robot.button("Release control").click();
  await expect(other.control).toHaveText("Nobody is in control");
  await other.takeControl();
});

test("a viewer sees everything and can change nothing", async ({ robot, other }) => {
  await robot.addUser("vic", "viewer", password);
  await robot.unlockRobot();
  await other.logIn("vic", password);
  await other.axis("Yaw").expectState("DISABLED");
  await expect(other.panel("Motors")).toContainText("You are logged in as viewer");
  for (const name of [
    "Enable Yaw",
    "Set Home Yaw",
    "Home all",
    "Zero all",
    "Request control",
    "Pull E-stop",
  ]) {
    await expect(other.button(name)).toBeDisabled();
  }
  await expect(other.axis("Yaw").row.getByRole("textbox")).toBeDisabled();
  await other.axis("Yaw").track.focus();
  await other.page.keyboard.press("ArrowLeft");
  await other.page.keyboard.press("Enter");
  await expect(other.page.getByRole("link", { name: "Users" })).toHaveCount(0);

  const answer = await other.page.evaluate(async () => {
    const response = await fetch("/api/motors/0/enable", { method: "POST" });
    return [response.status, (await response.json()).code];
  });
  expect(answer).toEqual([403, "ROLE"]);
  await robot.axis("Yaw").expectState("DISABLED");
  await expect(robot.proposal(1)).toHaveCount(0);
  await other.stop.click();
  await expect(other.stopAnswer).toHaveText("STOP accepted");
});
