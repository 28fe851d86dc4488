/** Texts of the page Network and of the pairing dialog: how devices reach the server. */
export const networkEn = {
  "network.title": "Network",
  "network.lead": "How tablets and headsets reach this server.",
  "network.mode.loopback": "This computer only",
  "network.mode.loopback.body":
    "No other device can reach the server, except headsets on a USB cable. For tablets, stop the server and start it with {{command}}.",
  "network.mode.lan": "Encrypted on the lab's network",
  "network.mode.lan.body": "Tablets and headsets on the same network reach it over https.",
  "network.mode.without_tls": "On the network without encryption",
  "network.mode.without_tls.body":
    "Anyone on the network can read passwords, answers and movement. Headsets refuse to enter VR. Start the server with --lan instead.",
  "network.addresses": "Addresses",
  "network.addresses.devices": "Tablets and headsets",
  "network.addresses.tablet": "QR code of the tablet's page, {{url}}",
  "network.addresses.scan": "The tablet's page",
  "network.addresses.headset": "QR code of the headset's page, {{url}}",
  "network.addresses.scan.headset": "The headset's page",
  "network.local": "This computer",
  "network.first": "Setting up a new device",
  "network.first.body":
    "Each device installs the lab's certificate once. This page shows how on iPad, Android, Meta Quest, Windows, Mac and Linux.",
  "network.first.qr": "QR code of the page that shows how to install the certificate",
  "network.certificate": "Certificate",
  "network.fingerprint": "Fingerprint (SHA-256)",
  "network.fingerprint.compare":
    "The help page on the device must show the same digits. If it does not, do not install anything.",
  "network.fingerprint.own": "This is your lab's own certificate.",
  "network.expires": "Valid until",
  "network.expires.authority":
    "{{date}}. Renewed automatically; there is nothing to do on the devices until {{authority}}.",
  "network.expires.own": "{{date}}. Replace it before then; no restart is needed.",
  "network.uncovered": "The certificate is not valid for some addresses of this computer",
  "network.uncovered.body":
    "{{addresses}}. Devices that use them see a warning. Run “./run tls renew --new-authority”; each device then installs the new certificate.",
  "network.uncovered.own": "{{addresses}}. Devices that use them see a warning.",
  "network.cable": "A headset on a USB cable",
  "network.cable.body":
    "No network or certificate needed. Connect the headset, allow debugging on it, and run on this computer:",
  "network.cable.then": "Then open this address in the headset's browser:",
  "network.none": "This computer has no network address",
  "network.none.body": "Once it is on a network, its addresses appear here within a minute.",
  "pairing.onlyHere": "Only this computer can reach the server",
  "pairing.onlyHere.body": "To let other devices in, stop the server and start it with:",
  "pairing.onlyHere.open.tablet": "Or open the tablet's page on this computer",
  "pairing.onlyHere.open.headset": "Or open the headset's page on this computer",
  "pairing.onlyHere.cable":
    "Or connect the headset with a USB cable, run the command and use the address:",
  "pairing.first": "New device? Install the certificate",
  "pairing.first.qr": "QR code of the page that helps to install the certificate",
};

export const networkDe: Readonly<Record<keyof typeof networkEn, string>> = {
  "network.title": "Netzwerk",
  "network.lead": "Wie Tablets und Headsets diesen Server erreichen.",
  "network.mode.loopback": "Nur dieser Rechner",
  "network.mode.loopback.body":
    "Außer Headsets am USB-Kabel erreicht kein anderes Gerät den Server. Für Tablets beenden Sie den Server und starten ihn mit {{command}}.",
  "network.mode.lan": "Verschlüsselt im Netz des Labors",
  "network.mode.lan.body": "Tablets und Headsets im selben Netz erreichen ihn über https.",
  "network.mode.without_tls": "Im Netz ohne Verschlüsselung",
  "network.mode.without_tls.body":
    "Jeder im Netz kann Passwörter, Antworten und Bewegung lesen. Headsets wechseln nicht in die VR. Starten Sie den Server stattdessen mit --lan.",
  "network.addresses": "Adressen",
  "network.addresses.devices": "Tablets und Headsets",
  "network.addresses.tablet": "QR-Code der Seite für das Tablet, {{url}}",
  "network.addresses.scan": "Seite für das Tablet",
  "network.addresses.headset": "QR-Code der Seite für das Headset, {{url}}",
  "network.addresses.scan.headset": "Seite für das Headset",
  "network.local": "Dieser Rechner",
  "network.first": "Ein neues Gerät einrichten",
  "network.first.body":
    "Jedes Gerät installiert das Zertifikat des Labors einmal. Diese Seite zeigt, wie das auf iPad, Android, Meta Quest, Windows, Mac und Linux geht.",
  "network.first.qr": "QR-Code der Seite, die zeigt, wie das Zertifikat installiert wird",
  "network.certificate": "Zertifikat",
  "network.fingerprint": "Fingerabdruck (SHA-256)",
  "network.fingerprint.compare":
    "Die Hilfeseite auf dem Gerät muss dieselben Ziffern zeigen. Wenn nicht, installieren Sie nichts.",
  "network.fingerprint.own": "Das ist das eigene Zertifikat Ihres Labors.",
  "network.expires": "Gültig bis",
  "network.expires.authority":
    "{{date}}. Wird automatisch erneuert; an den Geräten ist bis {{authority}} nichts zu tun.",
  "network.expires.own": "{{date}}. Ersetzen Sie es vorher; ein Neustart ist nicht nötig.",
  "network.uncovered": "Das Zertifikat gilt für manche Adressen dieses Rechners nicht",
  "network.uncovered.body":
    "{{addresses}}. Geräte, die sie benutzen, zeigen eine Warnung. Führen Sie „./run tls renew --new-authority“ aus; danach installiert jedes Gerät das neue Zertifikat.",
  "network.uncovered.own": "{{addresses}}. Geräte, die sie benutzen, zeigen eine Warnung.",
  "network.cable": "Ein Headset am USB-Kabel",
  "network.cable.body":
    "Braucht weder Netz noch Zertifikat. Verbinden Sie das Headset, erlauben Sie darauf das Debugging und führen Sie auf diesem Rechner aus:",
  "network.cable.then": "Öffnen Sie dann im Browser des Headsets:",
  "network.none": "Dieser Rechner hat keine Netzwerkadresse",
  "network.none.body":
    "Sobald er in einem Netz ist, erscheinen seine Adressen hier binnen einer Minute.",
  "pairing.onlyHere": "Nur dieser Rechner erreicht den Server",
  "pairing.onlyHere.body":
    "Damit andere Geräte ihn erreichen, beenden Sie den Server und starten ihn so:",
  "pairing.onlyHere.open.tablet": "Oder öffnen Sie die Seite für das Tablet auf diesem Rechner",
  "pairing.onlyHere.open.headset": "Oder öffnen Sie die Seite für das Headset auf diesem Rechner",
  "pairing.onlyHere.cable":
    "Oder verbinden Sie das Headset per USB-Kabel, führen den Befehl aus und benutzen die Adresse:",
  "pairing.first": "Neues Gerät? Installieren Sie das Zertifikat",
  "pairing.first.qr": "QR-Code der Seite, die beim Installieren des Zertifikats hilft",
};
