"""The help page's texts in English and German, and the choice of language for a browser.

`*bold*` marks what a person looks for on the device's screen, `` `code` `` what they type.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Device:
    """The steps for installing the certificate on one kind of device.

    `marks` occur in the user agent of its browsers.
    """

    key: str
    name: str
    steps: tuple[str, ...]
    marks: tuple[str, ...] = ()


@dataclass(frozen=True)
class HelpTexts:
    """All texts of the page in one language."""

    language: str
    other_name: str
    title: str
    lead: str
    download: str
    certificate: str
    profile: str
    pem: str
    compare: str
    compare_how: str
    compare_stop: str
    install: str
    go_on: str
    go_on_how: str
    tablet: str
    console: str
    elsewhere: str
    limits: str
    until: str
    devices: tuple[Device, ...]


ENGLISH = HelpTexts(
    language="en",
    other_name="Deutsch",
    title="Connect this device",
    lead=(
        "The lab's server encrypts what it sends and proves its identity with a certificate of the"
        " lab. Install that certificate on each device once; from then on every page opens without"
        " a warning."
    ),
    download="Get the certificate",
    certificate="Download certificate",
    profile="iPad, iPhone, Mac: profile",
    pem="as PEM file",
    compare="Compare the fingerprint",
    compare_how=(
        "SHA-256. The same digits are shown on the console's page *Network* and in the terminal of"
        " the lab's computer."
    ),
    compare_stop="If they differ, install nothing and inform the lab.",
    install="Install it",
    go_on="Continue over https",
    go_on_how="If the page opens without a warning, you are done.",
    tablet="Open the tablet's page",
    console="Open the console",
    elsewhere="This page, for another device",
    limits=(
        "This certificate is valid only for private networks and the lab's own computer, never for"
        " a website on the internet. Remove it from a device that leaves the lab."
    ),
    until="It is valid until {date}.",
    devices=(
        Device(
            "ios",
            "iPad and iPhone",
            (
                (
                    "Open this page in *Safari*, tap *iPad, iPhone, Mac: profile* above and then"
                    " *Allow*."
                ),
                (
                    "*Settings*, *General*, *VPN & Device Management*: tap the profile *Reembody*,"
                    " *Install*."
                ),
                (
                    "*Settings*, *General*, *About*, at the very bottom *Certificate Trust"
                    " Settings*:"
                    " switch *Reembody* on. Without this step Safari shows pages but refuses their"
                    " live connection."
                ),
                "Come back and continue with step 4.",
            ),
            ("iPad", "iPhone", "Macintosh"),
        ),
        Device(
            "android",
            "Android tablet or phone",
            (
                "Tap *Download certificate* above.",
                (
                    "*Settings*, *Security and privacy*, *More security settings*, *Encryption and"
                    " credentials*, *Install a certificate*, *CA certificate*. The place varies:"
                    " search the settings for *CA certificate*."
                ),
                "Tap *Install anyway* and choose `reembody-ca.crt` in *Downloads*.",
                (
                    "Use *Chrome*. Firefox needs a setting: *Settings*, *About Firefox*, tap"
                    " the logo"
                    " five times; then *Settings*, *Secret Settings*, *Use third party CA"
                    " certificates*."
                ),
            ),
            ("Android",),
        ),
        Device(
            "quest",
            "Meta Quest",
            (
                (
                    "Certificates cannot be installed on the headset. Use a cable: on the lab's"
                    " computer `adb reverse tcp:{port} tcp:{port}`, in the headset"
                    " `http://localhost:{port}`."
                ),
                (
                    "Without a cable: open the address of step 4 in the headset's browser. On the"
                    " warning choose *Advanced*, then *Proceed*. The browser remembers that for"
                    " a while;"
                    " do it before the participant arrives."
                ),
            ),
            ("OculusBrowser", "Quest"),
        ),
        Device(
            "windows",
            "Windows",
            (
                "Download the certificate, open it, *Install Certificate*.",
                (
                    "*Current User*, *Next*, *Place all certificates in the following store*,"
                    " *Browse*: *Trusted Root Certification Authorities*."
                ),
                "*Next*, *Finish*; confirm the question with *Yes*. Then restart Edge or Chrome.",
                "Or in a terminal: `certutil -user -addstore Root reembody-ca.crt`",
            ),
            ("Windows",),
        ),
        Device(
            "macos",
            "Mac",
            (
                "Download the certificate and open it: *Keychain Access* adds it to *login*.",
                (
                    "Open it there, unfold *Trust*, and set *When using this certificate* to "
                    "*Always Trust*. Close the window and confirm with your password."
                ),
                "Then restart Safari or Chrome.",
            ),
        ),
        Device(
            "firefox",
            "Firefox on a computer",
            (
                (
                    "*Settings*, *Privacy & Security*, *Certificates*, *View Certificates*,"
                    " *Authorities*, *Import*."
                ),
                "Choose `reembody-ca.crt` and tick *Trust this CA to identify websites*.",
            ),
            ("Firefox",),
        ),
        Device(
            "linux",
            "Linux",
            (
                (
                    "Chrome or Chromium: open `chrome://certificate-manager`, *Custom*,"
                    " *Installed by"
                    " you*, *Trusted Certificates*, *Import*."
                ),
                (
                    "Programs (Debian, Ubuntu): put the PEM file into"
                    " `/usr/local/share/ca-certificates/reembody.crt`, then"
                    " `sudo update-ca-certificates`."
                ),
            ),
            ("X11; Linux", "Wayland"),
        ),
    ),
)
GERMAN = HelpTexts(
    language="de",
    other_name="English",
    title="Dieses Gerät verbinden",
    lead=(
        "Der Server des Labors verschlüsselt, was er sendet, und weist sich mit einem Zertifikat "
        "des Labors aus. Installieren Sie dieses Zertifikat einmal auf jedem Gerät; danach "
        "öffnet sich jede Seite ohne Warnung."
    ),
    download="Zertifikat holen",
    certificate="Zertifikat laden",
    profile="iPad, iPhone, Mac: Profil",
    pem="als PEM-Datei",
    compare="Fingerabdruck vergleichen",
    compare_how=(
        "SHA-256. Dieselben Ziffern stehen in der Konsole auf der Seite *Netzwerk* und im Terminal"
        " des Laborrechners."
    ),
    compare_stop="Stimmen sie nicht überein, installieren Sie nichts und sagen Sie im Labor "
    "Bescheid.",
    install="Installieren",
    go_on="Weiter über https",
    go_on_how="Öffnet sich die Seite ohne Warnung, sind Sie fertig.",
    tablet="Seite für das Tablet öffnen",
    console="Konsole öffnen",
    elsewhere="Diese Seite für ein anderes Gerät",
    limits=(
        "Dieses Zertifikat gilt nur für private Netze und den Rechner des Labors, nie für eine "
        "Seite im Internet. Entfernen Sie es von Geräten, die das Labor verlassen."
    ),
    until="Es gilt bis {date}.",
    devices=(
        Device(
            "ios",
            "iPad und iPhone",
            (
                (
                    "Diese Seite in *Safari* öffnen, oben *iPad, iPhone, Mac: Profil*"
                    " antippen, dann"
                    " *Zulassen*."
                ),
                (
                    "*Einstellungen*, *Allgemein*, *VPN und Geräteverwaltung*: das Profil"
                    " *Reembody*"
                    " antippen, *Installieren*."
                ),
                (
                    "*Einstellungen*, *Allgemein*, *Info*, ganz unten"
                    " *Zertifikats\u00advertrauens\u00adeinstellungen*:"
                    " *Reembody* einschalten. Ohne diesen Schritt zeigt Safari zwar Seiten,"
                    " verweigert aber deren Live-Verbindung."
                ),
                "Hierher zurück und weiter mit Schritt 4.",
            ),
            ("iPad", "iPhone", "Macintosh"),
        ),
        Device(
            "android",
            "Android-Tablet oder -Telefon",
            (
                "Oben *Zertifikat laden* antippen.",
                (
                    "*Einstellungen*, *Sicherheit und Datenschutz*, *Weitere"
                    " Sicherheitseinstellungen*,"
                    " *Verschlüsselung und Anmeldedaten*, *Zertifikat installieren*,"
                    " *CA-Zertifikat*."
                    " Der Ort ist je nach Gerät anders: in den Einstellungen nach"
                    " *CA-Zertifikat* suchen."
                ),
                (
                    "*Trotzdem installieren* antippen und unter *Downloads* die Datei"
                    " `reembody-ca.crt`"
                    " wählen."
                ),
                (
                    "*Chrome* benutzen. Firefox braucht eine Einstellung: *Einstellungen*, *Über "
                    "Firefox*, fünfmal auf das Logo tippen; dann *Einstellungen*, *Secret "
                    "Settings*, *Use third party CA certificates*."
                ),
            ),
            ("Android",),
        ),
        Device(
            "quest",
            "Meta Quest",
            (
                (
                    "Auf dem Headset lassen sich keine Zertifikate installieren. Verwenden Sie "
                    "ein Kabel: am Laborrechner `adb reverse tcp:{port} tcp:{port}`, im Headset "
                    "`http://localhost:{port}`."
                ),
                (
                    "Ohne Kabel: die Adresse aus Schritt 4 im Browser des Headsets öffnen. Bei "
                    "der Warnung *Erweitert*, dann *Weiter* wählen. Der Browser merkt sich das "
                    "eine Weile; erledigen Sie es, bevor die teilnehmende Person kommt."
                ),
            ),
            ("OculusBrowser", "Quest"),
        ),
        Device(
            "windows",
            "Windows",
            (
                "Zertifikat laden, öffnen, *Zertifikat installieren*.",
                (
                    "*Aktueller Benutzer*, *Weiter*, *Alle Zertifikate in folgendem Speicher"
                    " speichern*, *Durchsuchen*: *Vertrauenswürdige Stammzertifizierungsstellen*."
                ),
                (
                    "*Weiter*, *Fertig stellen*; die Frage mit *Ja* bestätigen. Danach Edge"
                    " oder Chrome"
                    " neu starten."
                ),
                "Oder im Terminal: `certutil -user -addstore Root reembody-ca.crt`",
            ),
            ("Windows",),
        ),
        Device(
            "macos",
            "Mac",
            (
                (
                    "Zertifikat laden und öffnen: Die *Schlüsselbundverwaltung* nimmt es in "
                    "*Anmeldung* auf."
                ),
                (
                    "Dort öffnen, *Vertrauen* aufklappen, *Bei Verwendung dieses Zertifikats* "
                    "auf *Immer vertrauen* stellen. Fenster schließen und mit dem Passwort "
                    "bestätigen."
                ),
                "Danach Safari oder Chrome neu starten.",
            ),
        ),
        Device(
            "firefox",
            "Firefox am Rechner",
            (
                (
                    "*Einstellungen*, *Datenschutz & Sicherheit*, *Zertifikate*, *Zertifikate"
                    " anzeigen*, *Zertifizierungsstellen*, *Importieren*."
                ),
                (
                    "`reembody-ca.crt` wählen und *Dieser CA vertrauen, um Websites zu"
                    " identifizieren* ankreuzen."
                ),
            ),
            ("Firefox",),
        ),
        Device(
            "linux",
            "Linux",
            (
                (
                    "Chrome oder Chromium: `chrome://certificate-manager` öffnen,"
                    " *Benutzerdefiniert*,"
                    " *Von Ihnen installiert*, *Vertrauenswürdige Zertifikate*, *Importieren*."
                ),
                (
                    "Programme (Debian, Ubuntu): die PEM-Datei als"
                    " `/usr/local/share/ca-certificates/reembody.crt` ablegen, dann"
                    " `sudo update-ca-certificates`."
                ),
            ),
            ("X11; Linux", "Wayland"),
        ),
    ),
)


def texts_for(accept_language: str, chosen: str) -> HelpTexts:
    """Return the chosen language, else the browser's first supported one, else English."""
    offered = {"en": ENGLISH, "de": GERMAN}
    preferred = [part.partition(";")[0].strip()[:2].lower() for part in accept_language.split(",")]
    return next((offered[one] for one in (chosen, *preferred) if one in offered), ENGLISH)


def device_of(user_agent: str, texts: HelpTexts) -> str:
    """Return the key of the section that most likely fits a browser; empty if none does.

    An iPad identifies itself as a Macintosh; the owner of a Mac easily finds the next section.
    """
    order = ("quest", "android", "ios", "firefox", "windows", "linux")
    by_key = {device.key: device for device in texts.devices}
    return next((key for key in order if any(mark in user_agent for mark in by_key[key].marks)), "")
