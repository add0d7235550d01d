/** Navigation programs in the console: a real socket that speaks OpenIGTLink to a whole robot. */
import { expect, test } from "./fixtures";
import { NavigationProgram } from "./navigation_program";

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

test("only who holds the authority makes a program the controller", async ({ robot, stack }) => {
  const program = await NavigationProgram.connect(stack.igtlPort);
  try {
    const line = robot
      .panel("Navigation")
      .getByRole("listitem", { name: `Navigation program ${program.name}` });
    await expect(line).toContainText("observer");
    await line.getByRole("button", { name: /^Make controller/ }).click();
    await expect(line).toContainText("▶ controller");
    await robot.button("Release").click();
    await expect(line).toContainText("observer");
    await expect(line.getByRole("button", { name: /^Make controller/ })).toBeDisabled();
  } finally {
    program.end();
  }
});
