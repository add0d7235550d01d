/** Navigation programs in the console: a real socket that speaks OpenIGTLink to a whole robot. */
import { execFileSync } from "node:child_process";
import path from "node:path";
import { expect, test } from "./fixtures";
import { NavigationProgram } from "./navigation_program";
import { programs } from "./places";

test("a navigation program is shown with what it said, and disconnected", async ({ robot, stack }) => {
  const panel = robot.panel("Navigation");
  await expect(panel).toContainText("No navigation program is connected by OpenIGTLink.");
  const program = await NavigationProgram.connect(stack.igtlPort);
  try {
    program.send("GET_STATUS", "robot_status");
    program.send("NO_SUCH_TYPE", "nonsense");
    const line = panel.getByRole("listitem", { name: `Navigation program ${program.name}` });
    await expect(line).toContainText("thesis");
    await expect(line).toContainText("1 message refused");
    await line.getByText(/names? heard/).click();
    const heard = line.getByRole("row", { name: /^robot_status/ });
    await expect(heard).toContainText("GET_STATUS");
    const closed = program.closed();
    await line.getByRole("button", { name: /^Disconnect/ }).click();
    await closed;
    await expect(panel).toContainText("No navigation program is connected by OpenIGTLink.");
  } finally {
    program.end();
  }
});

test("only who is in control makes a program the controller", async ({ robot, stack }) => {
  const program = await NavigationProgram.connect(stack.igtlPort);
  try {
    const line = robot
      .panel("Navigation")
      .getByRole("listitem", { name: `Navigation program ${program.name}` });
    await expect(line).toContainText("observer");
    await line.getByRole("button", { name: /^Make controller/ }).click();
    await expect(line).toContainText("▶ controller");
    await robot.button("Release control").click();
    await expect(line).toContainText("observer");
    await expect(line.getByRole("button", { name: /^Make controller/ })).toBeDisabled();
  } finally {
    program.end();
  }
});

test("what an imager says stands in the status panel with its age, also once its program has gone", async ({
  robot,
  stack,
}) => {
  const imager = robot.panel("Status").getByLabel("Imager");
  await expect(imager).toContainText("no status heard");
  execFileSync(path.join(programs, "interlock"), [
    ...["igtl", "send", "string", "IMAGER_STATUS", "scanning"],
    ...["--port", String(stack.igtlPort)],
  ]);
  await expect(imager).toContainText(/scanning \d+\.\d s ago, from 127\.0\.0\.1:\d+/);
  await expect(imager).toContainText("no pose heard");
});
