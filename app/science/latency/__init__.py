"""The steps by which `app.science.achieved_latency` finds a lag.

`smoothing` makes curves of frames, `stretches` says what is compared, `correlation` looks at all
lags coarsely, `refinement` goes to the best one nearby, `choice` decides between several where the
movement repeats itself, and `uncertainty` says how sure the result is.
"""
