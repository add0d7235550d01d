/** Tells a password manager whose password the form has; nobody sees or types it. */
export function UserNameField({ name }: { readonly name: string }) {
  return <input hidden readOnly autoComplete="username" value={name} />;
}
