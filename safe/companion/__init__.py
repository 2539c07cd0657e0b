"""What only this book needs: the paper's numbers and claims, helpers of notebooks, measured speed."""
