/** What a new instrument begins with: small, complete, and ours. */
export const EXAMPLE = `# An instrument: items, what can be answered, and how answers become scores.
key: my_instrument
version: 1
title:
  en: My questionnaire
  de: Mein Fragebogen
languages: [en, de]

provenance:
  source: Where the wording comes from.
  licence: Under which licence, as far as you know.
  verified: What you compared with the source.

stem:
  en: How much do you agree?
  de: Wie sehr stimmen Sie zu?

scale:
  minimum: 1
  maximum: 5
  labels:
    - {en: not at all, de: gar nicht}
    - {en: completely, de: völlig}

items:
  - key: calm
    type: likert
    text: {en: I felt calm., de: Ich war ruhig.}
  - key: tense
    type: likert
    reverse_keyed: true
    text: {en: I felt tense., de: Ich war angespannt.}

# Before scoring every number x becomes this; leave it out to take answers as they are.
recode: x - 3

scores:
  - key: ease
    label: {en: Ease, de: Gelassenheit}
    formula: (calm - tense) / 2
    minimum: -2
    maximum: 2
`;
