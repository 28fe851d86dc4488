"""A scripted participant, headset, tablet and operator that use only the public interfaces."""
