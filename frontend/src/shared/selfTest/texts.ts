/** Names of what a self-test judges and what to do about it, for the headset and the console. */
export const verdictsEn = {
  "selftest.status.ok": "fine",
  "selftest.status.warn": "limited",
  "selftest.status.fail": "not good enough",
  "selftest.figure": "Figure",
  "selftest.value": "Measured",
  "selftest.limit": "Limit",
  "selftest.atLeast": "at least {{limit}}",
  "selftest.atMost": "at most {{limit}}",
  "selftest.none": "not measured",
  "selftest.none.do":
    "The browser does not tell it, or it could not be measured: an error of the page then says why.",
  "selftest.none.unworn": "Only a headset that somebody wears measures it.",
  "selftest.screen.slow":
    "Close other programs and tabs, keep this window in front and test again. Without a graphics card it stays slow.",
  "selftest.screen.storing": "Test again when server and network have nothing else to do.",
  "selftest.unknownDevice": "unnamed device",
  "selftest.input.controllers": "controllers",
  "selftest.input.hands": "hands",
  "selftest.input.body": "body tracking",
  "selftest.input.shins": "controllers on the shins",
  "selftest.input.trackers": "trackers",
  "selftest.input.desktop": "mouse and keyboard",
  "selftest.input.scripted": "scripted person",
  "selftest.nothing": "nothing",
  "verdict.duration": "Length of the test",
  "verdict.duration.do": "Let the test run to its end: heat and other programs show late.",
  "verdict.rendering_rate": "Frame rate",
  "verdict.rendering_rate.do":
    "Close other apps and tabs, end casting, let the headset cool down and test again.",
  "verdict.late_frames": "Late frames",
  "verdict.late_frames.do":
    "Close other apps and tabs, end casting, charge the battery above 30 % and test again.",
  "verdict.longest_frame": "Longest frame",
  "verdict.longest_frame.do":
    "Keep the headset on during the test, switch off notifications and test again.",
  "verdict.physics_speed": "Speed of the physics",
  "verdict.physics_speed.do":
    "Restart the headset and test again. If it stays slow, use a simpler body or a faster headset.",
  "verdict.physics_frame": "Physics of one frame",
  "verdict.physics_frame.do":
    "Restart the headset and test again. If it stays slow, use a simpler body or a faster headset.",
  "verdict.physics_resets": "Body put back",
  "verdict.physics_resets.do":
    "Test again with calm movements. If it happens again, tune the avatar's motors in the console.",
  "verdict.head_loss": "Longest loss of the head",
  "verdict.head_loss.do": "Switch on more light, wipe the cameras and draw the play area again.",
  "verdict.hands_loss": "Longest loss of a hand",
  "verdict.hands_loss.do":
    "Charge the controllers, keep the hands in view and switch on more light.",
  "verdict.hands_tracked": "Hands tracked",
  "verdict.hands_tracked.do":
    "Switch on both controllers, or lay both down and show both hands to the cameras.",
  "verdict.feet_tracked": "Feet tracked",
  "verdict.feet_tracked.do":
    "Only a foot task needs it: strap on trackers that the page “Headsets” of the help names.",
  "verdict.pose_rate": "New poses",
  "verdict.pose_rate.do":
    "Move during the test. If you did, charge the controllers and switch on more light.",
  "verdict.unacknowledged": "Batches not stored",
  "verdict.unacknowledged.do":
    "Move closer to the router, use its 5 GHz network or a cable, and test again.",
  "verdict.round_trip": "Time to store a batch",
  "verdict.round_trip.do":
    "Move closer to the router, use its 5 GHz network or a cable, and test again.",
  "verdict.page_errors": "Errors of the page",
  "verdict.page_errors.do":
    "Reload this page and test again. If errors stay, send the report to whoever runs the server.",
} as const;

export const verdictsDe: Readonly<Record<keyof typeof verdictsEn, string>> = {
  "selftest.status.ok": "in Ordnung",
  "selftest.status.warn": "eingeschränkt",
  "selftest.status.fail": "nicht gut genug",
  "selftest.figure": "Wert",
  "selftest.value": "Gemessen",
  "selftest.limit": "Grenze",
  "selftest.atLeast": "mindestens {{limit}}",
  "selftest.atMost": "höchstens {{limit}}",
  "selftest.none": "nicht gemessen",
  "selftest.none.do":
    "Der Browser teilt es nicht mit, oder es ließ sich nicht messen: Dann sagt ein Fehler der Seite, warum.",
  "selftest.none.unworn": "Nur eine VR-Brille, die jemand trägt, misst es.",
  "selftest.screen.slow":
    "Schließen Sie andere Programme und Tabs, lassen Sie dieses Fenster vorn und testen Sie noch einmal. Ohne Grafikkarte bleibt es langsam.",
  "selftest.screen.storing":
    "Testen Sie noch einmal, wenn Server und Netz nichts anderes zu tun haben.",
  "selftest.unknownDevice": "Gerät ohne Namen",
  "selftest.input.controllers": "Controller",
  "selftest.input.hands": "Hände",
  "selftest.input.body": "Körper-Tracking",
  "selftest.input.shins": "Controller an den Unterschenkeln",
  "selftest.input.trackers": "Tracker",
  "selftest.input.desktop": "Maus und Tastatur",
  "selftest.input.scripted": "Skript",
  "selftest.nothing": "nichts",
  "verdict.duration": "Länge des Tests",
  "verdict.duration.do":
    "Lassen Sie den Test bis zum Ende laufen: Wärme und andere Programme zeigen sich spät.",
  "verdict.rendering_rate": "Bildrate",
  "verdict.rendering_rate.do":
    "Schließen Sie andere Apps und Tabs, beenden Sie die Übertragung, lassen Sie die VR-Brille abkühlen und testen Sie noch einmal.",
  "verdict.late_frames": "Verspätete Bilder",
  "verdict.late_frames.do":
    "Schließen Sie andere Apps und Tabs, beenden Sie die Übertragung, laden Sie den Akku über 30 % und testen Sie noch einmal.",
  "verdict.longest_frame": "Längstes Bild",
  "verdict.longest_frame.do":
    "Behalten Sie die VR-Brille während des Tests auf, schalten Sie Mitteilungen aus und testen Sie noch einmal.",
  "verdict.physics_speed": "Geschwindigkeit der Physik",
  "verdict.physics_speed.do":
    "Starten Sie die VR-Brille neu und testen Sie noch einmal. Bleibt es langsam, nehmen Sie einen einfacheren Körper oder eine schnellere VR-Brille.",
  "verdict.physics_frame": "Physik eines Bildes",
  "verdict.physics_frame.do":
    "Starten Sie die VR-Brille neu und testen Sie noch einmal. Bleibt es langsam, nehmen Sie einen einfacheren Körper oder eine schnellere VR-Brille.",
  "verdict.physics_resets": "Körper zurückgesetzt",
  "verdict.physics_resets.do":
    "Testen Sie noch einmal mit ruhigen Bewegungen. Geschieht es wieder, stellen Sie die Motoren des Avatars in der Konsole neu ein.",
  "verdict.head_loss": "Längster Verlust des Kopfes",
  "verdict.head_loss.do":
    "Machen Sie mehr Licht, wischen Sie die Kameras ab und zeichnen Sie den Spielbereich neu.",
  "verdict.hands_loss": "Längster Verlust einer Hand",
  "verdict.hands_loss.do":
    "Laden Sie die Controller, halten Sie die Hände im Blick und machen Sie mehr Licht.",
  "verdict.hands_tracked": "Hände getrackt",
  "verdict.hands_tracked.do":
    "Schalten Sie beide Controller ein, oder legen Sie beide weg und zeigen Sie den Kameras beide Hände.",
  "verdict.feet_tracked": "Füße getrackt",
  "verdict.feet_tracked.do":
    "Nur eine Fußaufgabe braucht es: Schnallen Sie Tracker an, die in der Hilfe auf der Seite „Headsets“ stehen.",
  "verdict.pose_rate": "Neue Posen",
  "verdict.pose_rate.do":
    "Bewegen Sie sich während des Tests. Falls Sie das getan haben, laden Sie die Controller und machen Sie mehr Licht.",
  "verdict.unacknowledged": "Pakete nicht gespeichert",
  "verdict.unacknowledged.do":
    "Gehen Sie näher an den Router, nehmen Sie sein 5-GHz-Netz oder ein Kabel und testen Sie noch einmal.",
  "verdict.round_trip": "Zeit, um ein Paket zu speichern",
  "verdict.round_trip.do":
    "Gehen Sie näher an den Router, nehmen Sie sein 5-GHz-Netz oder ein Kabel und testen Sie noch einmal.",
  "verdict.page_errors": "Fehler der Seite",
  "verdict.page_errors.do":
    "Laden Sie diese Seite neu und testen Sie noch einmal. Bleiben Fehler, geben Sie den Bericht an die Person, die den Server betreibt.",
};
