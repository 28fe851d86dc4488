"""What every request needs, whatever the feature: access, context, hub, limiters, jobs."""
