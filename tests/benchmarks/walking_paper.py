"""Figures printed in the paper; an entry is empty if the paper shows it only in a picture."""

PAPER_PERCENTILES = (
    {
        "stat": (".052", ".262", ".514", ".838", "1.464"),
        "adapt": (".046", ".235", ".475", ".772", "1.350"),
        "prob": (".040", ".231", ".453", ".747", "1.212"),
    },
    {
        "stat": ("", ".462", ".850", "1.247", ""),
        "adapt": ("", ".436", ".771", "1.138", ""),
        "prob": ("", "", "", "", ""),
    },
)
PAPER_SWEEP = {10: "1.425", 20: "1.04", 50: ".609", 100: ".453", 200: ".376", 500: ".365"}
PAPER_SUBMODELS = {
    "nothing": ".453",
    "length_m": ".506",
    "turning_per_m": ".542",
    "stature_m": ".471",
    "velocity": ".545",
    "acceleration": ".507",
    "angular": ".495",
}
PAPER_LONG = {
    10.0: ("6.310 (.538)", "6.317 (.475)", "6.400"),
    25.0: ("15.685 (1.428)", "15.100 (1.183)", "14.833"),
    50.0: ("29.260 (2.395)", "28.750 (2.208)", "28.833"),
}
PAPER_TESTS = {
    ("stat", "adapt"): ("p .002, power .951", "p .002, power .953"),
    ("stat", "prob"): ("p .000, power 1.000", "p .000, power .992"),
    ("adapt", "prob"): ("p <= .015, power .687", "p <= .015, power .629"),
}
