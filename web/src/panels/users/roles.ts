import type { Role } from "../../api/client";

/** By rising rights. */
export const roles: readonly Role[] = ["viewer", "engineer", "admin"];
