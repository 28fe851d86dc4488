"""The help page in German."""

from app.lan.help.texts import Device, HelpTexts

GERMAN = HelpTexts(
    language="de",
    other_name="English",
    title="Dieses Gerät verbinden",
    lead=(
        "Der Server des Labors verschlüsselt, was er sendet, und weist sich mit einem Zertifikat"
        " des Labors aus. Jedes Gerät installiert dieses Zertifikat einmal; danach öffnet sich jede"
        " Seite ohne Warnung."
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
    compare_stop="Stimmen sie nicht überein: nichts installieren und im Labor Bescheid sagen.",
    install="Installieren",
    go_on="Weiter über https",
    go_on_how="Öffnet sich die Seite ohne Warnung, ist alles getan.",
    tablet="Seite für das Tablet öffnen",
    console="Konsole öffnen",
    elsewhere="Diese Seite für ein anderes Gerät",
    limits=(
        "Dieses Zertifikat kann nur für private Netze und den Rechner des Labors bürgen, nie für"
        " eine Seite im Internet. Von Geräten, die das Labor verlassen, sollte es entfernt werden."
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
                    " *Reembody* einschalten. Ohne diesen Schritt zeigt Safari Seiten und"
                    " verweigert"
                    " doch deren Live-Verbindung."
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
                    "*Chrome* benutzen. Firefox muss es erlaubt werden: *Einstellungen*,"
                    " *Über Firefox*,"
                    " fünfmal auf das Logo tippen; dann *Einstellungen*, *Secret Settings*,"
                    " *Use third"
                    " party CA certificates*."
                ),
            ),
            ("Android",),
        ),
        Device(
            "quest",
            "Meta Quest",
            (
                (
                    "Das Headset hat keine Seite, um Zertifikate zu installieren. Am besten ist ein"
                    " Kabel: am Laborrechner `adb reverse tcp:{port} tcp:{port}`, im Headset"
                    " `http://localhost:{port}`."
                ),
                (
                    "Ohne Kabel: die Adresse aus Schritt 4 im Browser des Headsets öffnen. Bei der"
                    " Warnung *Erweitert*, dann *Weiter* wählen. Der Browser merkt sich das"
                    " eine Weile;"
                    " am besten erledigen, bevor die Versuchsperson kommt."
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
                    "Zertifikat laden und öffnen: die *Schlüsselbundverwaltung* nimmt es in"
                    " *Anmeldung* auf."
                ),
                (
                    "Dort öffnen, *Vertrauen* aufklappen, *Bei Verwendung dieses Zertifikats* auf"
                    " *Immer vertrauen* stellen. Fenster schließen; das Kennwort bestätigt es."
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
