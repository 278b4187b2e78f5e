"""Text with a place: documents, quantities, expressions, and hints on spelling."""
