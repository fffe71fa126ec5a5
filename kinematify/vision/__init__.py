"""Question about the pieces of an object, and answers of a person or a vision-language model beside geometry."""
