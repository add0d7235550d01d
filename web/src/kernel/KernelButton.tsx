import type { ComponentProps } from "react";
import { CommandButton } from "../design/CommandButton";
import type { CodeName } from "../generated/catalog";
import { useRefusal } from "./useRefusal";

interface KernelButtonProps extends Omit<ComponentProps<typeof CommandButton>, "warning"> {
  /** What pressing it asks the kernel for, at once. */
  readonly request: Exclude<CodeName<"request">, "MOVE" | "HOME">;
  /** Of the axis; absent when it concerns the system. */
  readonly slot?: number;
}

/** A command for the kernel: says beforehand when the kernel would refuse it now. It can be pressed all the same. */
export function KernelButton({ request, slot, ...command }: KernelButtonProps) {
  const refusal = useRefusal((kernel) => kernel.judge(request, slot ?? 0));
  return <CommandButton {...command} warning={refusal} />;
}
