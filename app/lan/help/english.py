"""The help page in English."""

from app.lan.help.texts import Device, HelpTexts

ENGLISH = HelpTexts(
    language="en",
    other_name="Deutsch",
    title="Connect this device",
    lead=(
        "The lab's server encrypts what it sends and proves that it is itself with a certificate of"
        " the lab. Each device installs that certificate once; from then on every page opens"
        " without a warning."
    ),
    download="Get the certificate",
    certificate="Download certificate",
    profile="iPad, iPhone, Mac: profile",
    pem="as PEM file",
    compare="Compare the fingerprint",
    compare_how=(
        "SHA-256. The same digits stand on the console's page *Network* and in the terminal of the"
        " lab's computer."
    ),
    compare_stop="If they differ, install nothing and tell whoever runs the lab.",
    install="Install it",
    go_on="Go on over https",
    go_on_how="If the page opens without a warning, all is done.",
    tablet="Open the tablet's page",
    console="Open the console",
    elsewhere="This page, for another device",
    limits=(
        "This certificate can vouch for private networks and for the lab's own computer only, never"
        " for a site of the internet. Remove it from a device that leaves the lab."
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
                    " switch *Reembody* on. Without this step Safari shows pages and still refuses"
                    " their live connection."
                ),
                "Come back and go on with step 4.",
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
                    " credentials*, *Install a certificate*, *CA certificate*. Where it is differs:"
                    " search the settings for *CA certificate*."
                ),
                "Tap *Install anyway* and choose `reembody-ca.crt` in *Downloads*.",
                (
                    "Use *Chrome*. Firefox has to be told: *Settings*, *About Firefox*, tap"
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
                    "The headset has no page to install certificates. Best is a cable: in the lab's"
                    " computer `adb reverse tcp:{port} tcp:{port}`, in the headset"
                    " `http://localhost:{port}`."
                ),
                (
                    "Without a cable: open the address of step 4 in the headset's browser. On the"
                    " warning choose *Advanced*, then *Proceed*. The browser keeps that for"
                    " a while;"
                    " do it before the participant comes."
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
                "Download the certificate and open it: *Keychain Access* takes it into *login*.",
                (
                    "Open it there, unfold *Trust*, and set *When using this certificate* to"
                    " *Always Trust*. Close the window; your password confirms it."
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
