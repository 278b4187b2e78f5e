"""Text with places: documents, quantities, expressions and spelling hints."""
