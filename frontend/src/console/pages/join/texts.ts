/** Texts of signing in: by an invitation, after a sign-in has expired, and with a new password. */
export const joinEn = {
  "login.ended.title": "You have been signed out",
  "login.ended.body":
    "Your sign-in expired or was ended elsewhere. Sign in again to continue where you were: what you were writing on this page is kept.",
  "login.forgotten": "Forgotten your password? The administrator of the lab can invite you again.",
  "invited.title": "You are invited",
  "invited.as": "Your role will be",
  "invited.note": "“{{note}}”",
  "invited.until": "The link works once, until {{date}}.",
  "invited.username": "User name",
  "invited.username.hint":
    "It appears in the record of what you do. Letters, digits, dots, - and _.",
  "invited.submit": "Create account",
  "invited.used.title": "This link has already been used",
  "invited.used.body":
    "It works only once. If you used it, sign in. If not, tell the administrator of the lab immediately.",
  "invited.expired.title": "This link has expired",
  "invited.expired.body": "Ask the administrator of the lab for a new one.",
  "invited.revoked.title": "This invitation was revoked",
  "invited.revoked.body": "If you expected this invitation, ask the administrator of the lab.",
  "invited.unknown.title": "This invitation does not exist",
  "invited.unknown.body":
    "Part of the link may be missing: copy all of it. Otherwise ask the administrator of the lab for a new one.",
  "invited.signIn": "Go to sign-in",
  "invited.other.title": "You are signed in as {{name}}",
  "invited.other.body":
    "An invitation creates a new account. Sign out first if it is for someone else, or for you under another name.",
  "invited.other.stay": "Stay signed in as {{name}}",
  "password.change": "Change password",
  "password.current": "Current password",
  "password.new": "New password",
  "password.first": "Password",
  "password.again": "Repeat password",
  "password.others": "You stay signed in here; every other browser has to sign in again.",
  "password.done": "The password has been changed.",
  "password.rule.length": "At least {{least}} characters, such as four or five random words",
  "password.rule.different": "At least {{least}} different characters",
  "password.rule.name": "Not just the user name or the name of this program",
  "password.rule.same": "Both passwords match",
  "password.rules": "The password",
  "password.met": "met",
  "password.unmet": "not yet",
};

export const joinDe: Readonly<Record<keyof typeof joinEn, string>> = {
  "login.ended.title": "Sie wurden abgemeldet",
  "login.ended.body":
    "Ihre Anmeldung ist abgelaufen oder wurde anderswo beendet. Melden Sie sich wieder an, um weiterzumachen: Was Sie auf dieser Seite geschrieben haben, ist noch da.",
  "login.forgotten": "Passwort vergessen? Der Admin des Labors kann Sie neu einladen.",
  "invited.title": "Sie sind eingeladen",
  "invited.as": "Ihre künftige Rolle",
  "invited.note": "„{{note}}“",
  "invited.until": "Der Link funktioniert einmal, bis {{date}}.",
  "invited.username": "Benutzername",
  "invited.username.hint":
    "Er erscheint in den Protokollen neben dem, was Sie tun. Buchstaben, Ziffern, Punkte, - und _.",
  "invited.submit": "Konto anlegen",
  "invited.used.title": "Dieser Link wurde schon benutzt",
  "invited.used.body":
    "Er funktioniert nur einmal. Wenn Sie ihn benutzt haben, melden Sie sich an. Wenn nicht, sagen Sie es sofort dem Admin des Labors.",
  "invited.expired.title": "Dieser Link ist abgelaufen",
  "invited.expired.body": "Bitten Sie den Admin des Labors um einen neuen.",
  "invited.revoked.title": "Diese Einladung wurde zurückgenommen",
  "invited.revoked.body":
    "Wenn Sie diese Einladung erwartet haben, fragen Sie den Admin des Labors.",
  "invited.unknown.title": "Diese Einladung gibt es nicht",
  "invited.unknown.body":
    "Vielleicht fehlt ein Teil des Links: Kopieren Sie ihn ganz. Sonst bitten Sie den Admin des Labors um einen neuen.",
  "invited.signIn": "Zur Anmeldung",
  "invited.other.title": "Sie sind als {{name}} angemeldet",
  "invited.other.body":
    "Eine Einladung legt ein neues Konto an. Melden Sie sich zuerst ab, wenn sie für jemand anderen ist oder für Sie unter einem anderen Namen.",
  "invited.other.stay": "Als {{name}} angemeldet bleiben",
  "password.change": "Passwort ändern",
  "password.current": "Aktuelles Passwort",
  "password.new": "Neues Passwort",
  "password.first": "Passwort",
  "password.again": "Passwort wiederholen",
  "password.others": "Hier bleiben Sie angemeldet; jeder andere Browser muss sich neu anmelden.",
  "password.done": "Das Passwort wurde geändert.",
  "password.rule.length": "Mindestens {{least}} Zeichen, etwa vier oder fünf zufällige Wörter",
  "password.rule.different": "Mindestens {{least}} verschiedene Zeichen",
  "password.rule.name": "Nicht nur der Benutzername oder der Name dieses Programms",
  "password.rule.same": "Beide Passwörter stimmen überein",
  "password.rules": "Das Passwort",
  "password.met": "erfüllt",
  "password.unmet": "noch nicht",
};
