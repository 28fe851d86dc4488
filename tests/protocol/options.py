"""The shipped study with practice, a signed consent and a stop rule on sickness."""

from tests.protocol.helpers import edited

KEY = "reembodiment-options"
CONSENT = """
    - step: consent
      text: consent
      signature: drawn
      statements:
        - text: {en: I have read the page above., de: Ich habe die Seite oben gelesen.}
        - text: {en: I agree to take part., de: Ich nehme freiwillig teil.}
        - text:
            en: My data may be used in later studies.
            de: Meine Daten dürfen in späteren Studien verwendet werden.
          optional: true
"""
PRACTICE = """
    - step: practice
      limb: hand
      preparation_s: 1
      duration_s: 30
      freeze_s: 1
      latency_ms: 0
      repeat_until_completions: 2
      text: hand_task
"""
SAFETY = """safety:
  stop_rules:
    - {instrument: fms, score: sickness_score, stop_at: 15, warn_at: 10}
"""


def with_options(*changes: tuple[str, str]) -> str:
    """Return the study's text with FMS after each block, then with words replaced."""
    text = edited(
        ("key: reembodiment-latency", f"key: {KEY}"),
        ("\n    - {step: consent, text: consent}\n", CONSENT),
        ("    - {step: free_roam", f"{PRACTICE.removeprefix(chr(10))}    - {{step: free_roam"),
        ("    phases:\n", "    after: [{step: form, instrument: fms}]\n    phases:\n"),
        ("on_disconnect: pause\n", f"on_disconnect: pause\n{SAFETY}"),
    )
    for old, new in changes:
        assert old in text, f"{old!r} is not in the study"
        text = text.replace(old, new, 1)
    return text
