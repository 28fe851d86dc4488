"""Infrastructure shared by all features: access control, context, hub, rate limits, jobs."""
