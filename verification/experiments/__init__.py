"""Published experiments against predictions: data, scenes, comparison; `searched.toml`: what was searched."""
