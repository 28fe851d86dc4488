"""A scripted participant, headset, tablet and operator over the public interfaces."""
