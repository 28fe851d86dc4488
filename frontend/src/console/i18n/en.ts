/** The console's texts in English; `de.ts` has the same keys. */
export const en = {
  "app.name": "Reembody",
  "app.studies": "Studies",
  "app.logout": "Sign out",
  "app.signedInAs": "Signed in as {{name}} ({{role}})",
  "app.account": "Account",
  "app.theme.dark": "Dark appearance",
  "app.theme.light": "Light appearance",
  "app.language": "Deutsch",
  "app.skip": "Skip to content",
  "error.unreachable": "The server does not answer.",
  "error.unreachableRemedy":
    "Check that it is running and that this computer is on its network. Nothing on the server is lost.",
  "error.unexpected": "Something on this page went wrong.",
  "error.retry": "Try again",
  "login.title": "Sign in",
  "login.lead": "Run, watch and analyse re-embodiment studies.",
  "login.username": "User name",
  "login.password": "Password",
  "login.submit": "Sign in",
  "login.hint":
    "The first account is admin. Its password was printed once when the server first started.",
} as const;
