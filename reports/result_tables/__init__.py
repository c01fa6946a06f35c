"""Tables of the page of numbers (`reports.results_page`), as Markdown, by subject."""
