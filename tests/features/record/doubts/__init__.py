"""Tests of doubts about what a headset reports."""
